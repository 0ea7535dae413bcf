#include "cuda/scene/device_tree.h"

#include "cuda/stream/device_pool.h"

namespace voyager::cuda {

DeviceTree::DeviceTree(const SearchTree& search, const LodTree& tree) {
  const OwnerRuns owners = make_owner_runs(search);
  allocate_together(ToAllocate{subtrees_, search.subtrees.size()},
                    ToAllocate{records_, search.records.size()},
                    ToAllocate{chunks_, search.chunks.size()},
                    ToAllocate{leaves_, search.leaves_have_extent ? tree.records.size() : 0},
                    ToAllocate{owner_runs_, owners.runs.size()},
                    ToAllocate{run_subtrees_, owners.subtrees.size()});
  upload<SearchSubtree>(search.subtrees, subtrees_);
  upload<SearchRecord>(search.records, records_);
  upload<SearchChunk>(search.chunks, chunks_);
  if (search.leaves_have_extent) upload<NodeRecord>(tree.records, leaves_);
  upload<RunBlock>(owners.runs, owner_runs_);
  upload<uint32_t>(owners.subtrees, run_subtrees_);
  view_ = {subtrees_.data(),   {nullptr},       records_.data(),        nullptr,
           chunks_.data(),     leaves_.data(),  search.subtree_count(), search.subtree_count(),
           search.chunk_count, tree.blend_share};
}

TreeView DeviceTree::view() const {
  return pool_ == nullptr ? view_ : pool_->tree();
}

}  // namespace voyager::cuda
