#pragma once
#include "cuda/scene/device_scene.h"
#include "cuda/search/search.h"
#include "runtime/stages/interpolate.h"

namespace voyager::cuda {

// ShapeRest::children of a coded scene, wherever it is.
__device__ inline uint32_t few_children(const GaussianView& gaussians, uint32_t node) {
  if (!gaussians.parents.owners_in_shapes())
    return __ldg(&(static_cast<const ShapeRest*>(gaussians.shapes) + node)->children);
  const auto* rows = static_cast<const uint8_t*>(gaussians.coefficients);
  return __ldg(rows + size_t{node} * sh_row_bytes(gaussians.sh_degree) +
               sh_spare_byte(gaussians.sh_degree));
}

// How many children a node has that is not a leaf.
__device__ inline uint32_t child_count(const GaussianView& gaussians, uint32_t node) {
  if (gaussians.sh_form != ShForm::coded) return __ldg(gaussians.child_counts + node);
  const uint32_t few = few_children(gaussians, node);
  if (few != kManyChildren) return few;
  return children_of(node, gaussians.large_families, *gaussians.large_family_count);
}

// What a place of the list draws whose node has that weight.
__device__ inline DrawItem item_of(const GaussianView& gaussians, uint32_t node, float t) {
  DrawItem item{node, kNoNode, t, 1.0f};
  if (t == 1.0f) return item;
  item.parent = gaussians.parents(node);
  item.inverse_k = 1.0f / static_cast<float>(child_count(gaussians, item.parent));
  return drawn_item(item, gaussians.doubles);
}

__device__ inline uint32_t node_at(const CutList& list, uint32_t place) {
  return list.nodes == nullptr ? place : __ldg(list.nodes + place);
}

// What a place of the list draws; its Gaussian is kNoNode where it draws nothing.
template <bool kLod>
__device__ DrawItem item_at(const GaussianView& gaussians, const CutList& list, uint32_t place) {
  const uint32_t node = node_at(list, place);
  if (!kLod || node == kNoNode) return {node, kNoNode, 1.0f, 1.0f};
  return item_of(gaussians, node, __ldg(list.weights + place));
}

}  // namespace voyager::cuda
