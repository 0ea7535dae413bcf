#include "cuda/scene/device_tree.h"

#include "cuda/stream/device_pool.h"

namespace voyager::cuda {

DeviceTree::DeviceTree(const SearchTree& search, const LodTree& tree)
    : subtrees_(upload(std::span<const SearchSubtree>(search.subtrees))),
      records_(upload(std::span<const SearchRecord>(search.records))),
      chunks_(upload(std::span<const SearchChunk>(search.chunks))) {
  if (search.leaves_have_extent) leaves_ = upload(std::span<const NodeRecord>(tree.records));
  const OwnerRuns owners = make_owner_runs(search);
  owner_runs_ = upload(std::span<const RunBlock>(owners.runs));
  run_subtrees_ = upload(std::span<const uint32_t>(owners.subtrees));
  view_ = {subtrees_.data(),   {nullptr},       records_.data(),        nullptr,
           chunks_.data(),     leaves_.data(),  search.subtree_count(), search.subtree_count(),
           search.chunk_count, tree.blend_share};
}

TreeView DeviceTree::view() const {
  return pool_ == nullptr ? view_ : pool_->tree();
}

}  // namespace voyager::cuda
