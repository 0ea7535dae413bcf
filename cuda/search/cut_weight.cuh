#pragma once
// The weight of a node of a cut, from the records that it depends on (METHOD §4).
#include "cuda/search/cut_lanes.cuh"
#include "runtime/math/lerp.h"

namespace voyager::cuda {

__device__ inline float record_size(const WeightSource& from, uint32_t record) {
  return load_record(from.tree.records + record).bounds().screen_size(from.sight.centre);
}

__device__ inline float own_size(const WeightSource& from, uint32_t record, uint32_t node) {
  if (record != kNoRecord) return record_size(from, record);
  if (from.tree.leaves == nullptr) return 0.0f;
  const NodeRecord& leaf = from.tree.leaves[node];
  return screen_size(from.sight.centre, leaf.box_min, leaf.box_max, leaf.extent);
}

// t of a node of the cut.
__device__ inline float weight_of(const WeightSource& from, uint32_t node) {
  const SearchSubtree s = load_own_subtree(from.tree, from.tree.places(from.owner(node)));
  const CutOrigin origin = s.origin(s.slot_of(node), from.tree.next_block);
  const bool has_parent = origin.parent != kNoRecord;
  const float parent = has_parent ? record_size(from, origin.parent) : 0.0f;
  return interpolation_weight(has_parent, parent, own_size(from, origin.own, node),
                              from.sight.target_size, from.tree.blend_share);
}

}  // namespace voyager::cuda
