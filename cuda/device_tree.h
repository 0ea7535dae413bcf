#pragma once
// The arrays that searches read, on the device: shared by all views of a scene.
#include "cuda/buffer.h"
#include "runtime/lod/tree.h"
#include "runtime/select/search_tree.h"

namespace voyager::cuda {

// As kernels take it.
struct TreeView {
  const SearchSubtree* subtrees;
  const SearchRecord* records;
  const SubtreeSpan* opens;
  const SearchChunk* chunks;
  const NodeRecord* leaves;  // all nodes by id, where leaves have extents; else null
  uint32_t subtree_count, chunk_count;
};

// What the partitioned searches need.
class DeviceTree {
 public:
  DeviceTree(const SearchTree& search, const LodTree& tree)
      : subtrees_(upload(std::span<const SearchSubtree>(search.subtrees))),
        records_(upload(std::span<const SearchRecord>(search.records))),
        opens_(upload(std::span<const SubtreeSpan>(search.opens))),
        chunks_(upload(std::span<const SearchChunk>(search.chunks))) {
    if (search.leaves_have_extent) leaves_ = upload(std::span<const NodeRecord>(tree.records));
  }

  TreeView view() const {
    return {subtrees_.data(),
            records_.data(),
            opens_.data(),
            chunks_.data(),
            leaves_.data(),
            static_cast<uint32_t>(subtrees_.size()),
            static_cast<uint32_t>(chunks_.size() == 0 ? 0 : chunks_.size() - 1)};
  }

 private:
  Buffer<SearchSubtree> subtrees_;
  Buffer<SearchRecord> records_;
  Buffer<SubtreeSpan> opens_;
  Buffer<SearchChunk> chunks_;
  Buffer<NodeRecord> leaves_;
};

}  // namespace voyager::cuda
