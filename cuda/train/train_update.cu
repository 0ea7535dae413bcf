// Adam, of the merged nodes that a cut shows and of the parents that it blends with. A warp a
// place: its lanes share the numbers of a row.
#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/scene/device_gaussian.h"
#include "cuda/splat/draw_item.cuh"
#include "cuda/train/train_launch.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kThreads = 256;

struct UpdateParams {
  GaussianView gaussians;
  CutList list;
  const float* gradients;
  TrainedArrays arrays;
  LearningRates rates;
};

__device__ DrawItem item_of(const UpdateParams& p, uint32_t place) {
  return item_at<true>(p.gaussians, p.list, place);
}
__device__ const float* gradient_of(const UpdateParams& p, uint32_t place) {
  return p.gradients + size_t{place} * gradient_stride(p.arrays.sh_degree);
}

__device__ Gaussian stored(const UpdateParams& p, uint32_t node) {
  const float4 hull = p.arrays.hulls[node];
  const float4 a = p.arrays.shapes[2 * size_t{node}], b = p.arrays.shapes[2 * size_t{node} + 1];
  return {{hull.x, hull.y, hull.z},
          p.arrays.opacities[node],
          {a.x, a.y, a.z},
          a.w,
          {b.x, b.y, b.z, b.w}};
}

__device__ float moved(const UpdateParams& p, size_t at, float gradient, float rate,
                       const AdamStep& step) {
  return step.move(gradient, rate, p.arrays.first[at], p.arrays.second[at]);
}

// By one lane.
__device__ void move_shape(const UpdateParams& p, uint32_t node, size_t row,
                           const ShapeGradient& gradient, const AdamStep& step) {
  Gaussian g = stored(p, node);
  float moves[kShapeNumbers];
  const float largest = detail::largest(g.scale);
  for (int i = 0; i < kShapeNumbers; ++i)
    moves[i] = moved(p, row + i, gradient.by[i], p.rates.of_shape(i, largest), step);
  voyager::move_shape(moves, g);
  p.arrays.hulls[node] = device_hull(g);
  p.arrays.shapes[2 * size_t{node}] = {g.scale.x, g.scale.y, g.scale.z, g.log_opacity};
  p.arrays.shapes[2 * size_t{node} + 1] = {g.rotation.w, g.rotation.x, g.rotation.y, g.rotation.z};
  p.arrays.opacities[node] = g.opacity;
}

// Siblings that blend with one parent: places [first, last) of the list, each with its share.
struct Places {
  uint32_t first, last;
};

// By a warp. parent: whether the node is the parent of what the places draw.
__device__ void move_node(const UpdateParams& p, uint32_t node, const Places& places, bool parent) {
  const uint32_t lane = lane_in_warp(), row = p.arrays.row_of[node];
  if (row == kNoNode) return;
  const size_t at = size_t{row} * numbers_of(p.arrays.sh_degree);
  const AdamStep step(p.rates, p.arrays.steps[row] + 1);
  const auto share_of = [&](const DrawItem& item) { return parent ? 1.0f - item.t : item.t; };
  const int coefficients = 3 * sh_coefficients(p.arrays.sh_degree);
  for (int k = static_cast<int>(lane); k < coefficients; k += 32) {
    float sum = 0.0f;
    for (uint32_t place = places.first; place < places.last; ++place) {
      const float* g = gradient_of(p, place);
      if (g[0] != 0.0f) sum += share_of(item_of(p, place)) * g[kGradientHead + kShapeNumbers + k];
    }
    p.arrays.coefficients[size_t{node} * coefficients + k] -=
        moved(p, at + kShapeNumbers + k, sum, p.rates.of_coefficient(k), step);
  }
  __syncwarp();  // all have read the number of steps
  if (lane == 0) {
    ShapeGradient gradient{};
    const Gaussian g = stored(p, node);
    for (uint32_t place = places.first; place < places.last; ++place) {
      const float* from = gradient_of(p, place);
      if (from[0] == 0.0f) continue;
      add_share(from + kGradientHead, share_of(item_of(p, place)), parent ? from[1] : 1.0f, from[2],
                g, gradient);
    }
    move_shape(p, node, at, gradient, step);
    p.arrays.steps[row] = step.number;
  }
}

__global__ void __launch_bounds__(kThreads) train_update(UpdateParams p, bool parents) {
  const uint32_t places = *p.list.size, warps = gridDim.x * (kThreads / 32);
  for (uint32_t place = (blockIdx.x * kThreads + threadIdx.x) / 32; place < places;
       place += warps) {
    const DrawItem item = item_of(p, place);
    if (!parents) {
      if (gradient_of(p, place)[0] != 0.0f) move_node(p, item.gaussian, {place, place + 1}, false);
      continue;
    }
    if (item.parent == kNoNode) continue;
    if (place != 0 && item_of(p, place - 1).parent == item.parent) continue;
    Places siblings{place, place + 1};
    bool any = gradient_of(p, place)[0] != 0.0f;
    while (siblings.last < places && item_of(p, siblings.last).parent == item.parent)
      any = gradient_of(p, siblings.last++)[0] != 0.0f || any;
    if (any) move_node(p, item.parent, siblings, true);
  }
}

}  // namespace

// In any order: gradients are found, and no node reads what another moves.
void launch_train_update(const SplatFrame& f, const float* gradients, const TrainedArrays& arrays,
                         const LearningRates& rates) {
  const unsigned resident = resident_blocks<train_update, kThreads>();
  const UpdateParams params{f.gaussians, f.draws.list, gradients, arrays, rates};
  for (const bool parents : {true, false}) {
    launch_kernel("train_update", train_update, {f.multiprocessors * resident, kThreads, f.stream},
                  params, parents);
  }
}

}  // namespace voyager::cuda
