// The adjoint of projection (runtime/stages/project_gradient.h), of each place of a list.
#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/scene/device_arrays.cuh"
#include "cuda/splat/draw_item.cuh"
#include "cuda/train/fixed_sum.cuh"
#include "runtime/stages/project_gradient.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kThreads = 128;

// False where nothing was blended.
__device__ bool read_sums(const FixedSum* from, SplatSums<float>& sums) {
  float values[kSums - 1];
  FixedSum any = 0;
#pragma unroll
  for (int i = 0; i < kSums - 1; ++i) {
    any |= from[i];
    values[i] = fixed_value(from[i]);
  }
  sums = {values[0],
          values[1],
          values[2],
          values[3],
          values[4],
          values[5],
          {values[6], values[7], values[8]}};
  return any != 0;
}

__global__ void __launch_bounds__(kThreads)
    train_project(SplatFrame f, const FixedSum* sums, float* gradients) {
  const DeviceArrays<FloatSh> arrays{f.gaussians};
  const ProjectParams& params = f.params[0];
  const uint32_t places = *f.draws.list.size;
  const int degree = f.gaussians.sh_degree;
  for (uint32_t place = blockIdx.x * kThreads + threadIdx.x; place < places;
       place += gridDim.x * kThreads) {
    float* into = gradients + size_t{place} * gradient_stride(degree);
    SplatSums<float> sum;
    into[0] = 0.0f;
    if (place >= f.splats.places) continue;  // has_room() refuses such a picture
    const RankRow row = f.splats.ranks[place / kRowPlaces];
    if (!row.has(place)) continue;
    const uint32_t slot = row.slot(place);
    if (slot >= f.splats.slots) continue;
    if (!read_sums(sums + size_t{slot} * kSums, sum)) continue;
    const DrawItem item = item_at<true>(f.gaussians, f.draws.list, place);
    const Vec3f relative =
        camera_relative(interpolated_mean(arrays, item), params.origin, params.eye);
    const Shape<float> shape = interpolated_shape<float>(arrays, item);
    GaussianGradient<float> g = shape_gradient(params.view, filter_of(params, arrays, item),
                                               params.log_scale, relative, shape, sum);
    const SplatRecord& record = f.splats.records[slot];
    float* coefficients = into + kGradientHead + kShapeNumbers;
    const auto own = arrays.sh(item.gaussian);
    const auto put = [&](int k, int channel, float by) { coefficients[3 * k + channel] = by; };
    const Vec3f colour{record.r, record.g, record.b};
    if (item.t == 1.0f) {
      g.mean = g.mean + colour_gradient(degree, relative, colour, sum.colour, own, put);
    } else {
      const auto parent = arrays.sh(item.parent);
      const auto blended = [&](int k, int channel) {
        return lerp(parent(k, channel), own(k, channel), item.t);
      };
      g.mean = g.mean + colour_gradient(degree, relative, colour, sum.colour, blended, put);
    }
    const float numbers[kShapeNumbers] = {g.mean.x,     g.mean.y,     g.mean.z,     g.scale.x,
                                          g.scale.y,    g.scale.z,    g.rotation.w, g.rotation.x,
                                          g.rotation.y, g.rotation.z, g.log_opacity};
    bool finite = true;
#pragma unroll
    for (int i = 0; i < kShapeNumbers; ++i) {
      finite = finite && isfinite(numbers[i]);
      into[kGradientHead + i] = numbers[i];
    }
    into[0] = finite ? 1.0f : 0.0f;
    into[1] = parent_sign(arrays, item);
    into[2] = item.t == 1.0f ? expf(shape.log_opacity) : shape.opacity;
  }
}

}  // namespace

void launch_train_project(const SplatFrame& f, const FixedSum* sums, float* gradients) {
  const unsigned resident = resident_blocks<train_project, kThreads>();
  launch_kernel("train_project", train_project, {f.multiprocessors * resident, kThreads, f.stream},
                f, sums, gradients);
}

}  // namespace voyager::cuda
