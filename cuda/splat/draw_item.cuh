#pragma once
#include "cuda/scene/device_scene.h"
#include "cuda/search/search.h"
#include "runtime/stages/interpolate.h"

namespace voyager::cuda {

// What a place of the list draws; its Gaussian is kNoNode where it draws nothing.
template <bool kLod>
__device__ DrawItem item_at(const GaussianView& gaussians, const CutList& list, uint32_t place) {
  const uint32_t gaussian = list.nodes == nullptr ? place : __ldg(list.nodes + place);
  DrawItem item{gaussian, kNoNode, 1.0f, 1.0f};
  if (!kLod || gaussian == kNoNode) return item;
  item.t = __ldg(list.weights + place);
  if (item.t == 1.0f) return item;
  item.parent = __ldg(gaussians.parents + gaussian);
  item.inverse_k = 1.0f / static_cast<float>(__ldg(gaussians.child_counts + item.parent));
  return drawn_item(item, gaussians.doubles);
}

}  // namespace voyager::cuda
