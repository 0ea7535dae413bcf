// The stages of the baseline, each as 3DGS has it.
#include <thrust/iterator/transform_iterator.h>

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>

#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/scene/device_arrays.cuh"
#include "cuda/splat/baseline_launch.h"
#include "cuda/splat/draw_item.cuh"
#include "cuda/splat/raster_output.cuh"

namespace voyager::cuda {
namespace {

constexpr unsigned kThreads = 256;

unsigned blocks_for(unsigned long long count) {
  return static_cast<unsigned>((count + kThreads - 1) / kThreads);
}

// The box of 3σ of the longer axis, in tiles.
__device__ void baseline_box(const ImageCovariance<float>& c, float x, float y,
                             const TileGrid& grid, TileRange& columns, TileRange& rows) {
  const float mid = 0.5f * (c.xx + c.yy), det = c.y_given_x * c.xx;
  const float longest = mid + sqrtf(fmaxf(0.1f, mid * mid - det));
  const float radius = ceilf(3.0f * sqrtf(longest));
  const auto range = [&](float centre, int32_t count) {
    const float most = static_cast<float>(count) * kTile;
    const auto first = static_cast<int32_t>(fminf(fmaxf(centre - radius, 0.0f), most)) / kTile;
    const auto last =
        static_cast<int32_t>(fminf(fmaxf(centre + radius + kTile - 1, 0.0f), most)) / kTile;
    return TileRange{first, last};
  };
  columns = range(x, grid.columns);
  rows = range(y, grid.rows);
}

template <class Sh, bool kLod>
__device__ bool baseline_splat(const BaselineFrame& f, uint32_t place) {
  const DrawItem item = item_at<kLod>(f.gaussians, f.draws.list, place);
  if (item.gaussian == kNoNode) return false;
  const DeviceArrays<Sh> arrays{f.gaussians};
  const Vec3f mean = interpolated_mean(arrays, item);
  if (!is_inside(f.params.clip, mean)) return false;
  const Vec3f d = camera_relative(mean, f.params.origin, f.params.eye);
  const Vec3f view = detail::to_view(f.params, d);
  if (!(view.z > f.params.near_z)) return false;
  Shape<float> shape = interpolated_shape<float>(arrays, item);
  fade(shape, f.params.opacity, f.params.log_opacity);
  const PixelFilter<float>& filter = f.params.filter;
  if (filter.footprint > 0.0f)
    shape.scale = widened(shape.scale, interpolated_footprint(arrays, item, filter.footprint));
  const ImageCovariance<float> covariance = image_covariance(
      image_jacobian(f.params.view, view), shape.rotation, shape.scale, filter.low_pass);
  BaselineSplat splat;
  splat.x = detail::image_x(f.params, view);
  splat.y = detail::image_y(f.params, view);
  TileRange columns, rows;
  baseline_box(covariance, splat.x, splat.y, f.view.grid, columns, rows);
  if (columns.begin >= columns.end || rows.begin >= rows.end) return false;
  const float inverse_det = 1.0f / (covariance.y_given_x * covariance.xx);
  splat.a = covariance.yy * inverse_det;
  splat.b = -covariance.xy * inverse_det;
  splat.c = covariance.xx * inverse_det;
  splat.opacity = expf(shape.log_opacity);
  if (filter.compensated) splat.opacity *= sqrtf(covariance.kept);
  const Vec3f colour = interpolated_colour(arrays, item, (1.0f / std::sqrt(dot(d, d))) * d);
  splat.red = colour.x, splat.green = colour.y, splat.blue = colour.z;
  splat.depth = sort_depth(view.z, f.params.depth_scale);
  splat.t = item.t;
  splat.inverse_k = item.inverse_k;
  const uint32_t at = f.first + place;
  f.view.splats[at] = splat;
  f.view.rows[at] = rows;
  f.view.columns[at] = columns;
  f.view.tile_counts[at] =
      static_cast<uint32_t>((rows.end - rows.begin) * (columns.end - columns.begin));
  return true;
}

template <class Sh, bool kLod>
__global__ void __launch_bounds__(kThreads) baseline_project(BaselineFrame f) {
  const uint32_t place = blockIdx.x * kThreads + threadIdx.x;
  if (place >= f.places) return;
  if (!baseline_splat<Sh, kLod>(f, place)) {
    f.view.tile_counts[f.first + place] = 0;
    f.view.rows[f.first + place] = {0, 0};
  }
}

// Pairs in the order of the places: the sort is stable, so that ties of depth stay in it.
__global__ void __launch_bounds__(kThreads) baseline_keys(BaselineView view) {
  const uint32_t place = blockIdx.x * kThreads + threadIdx.x;
  if (place >= view.places || view.tile_counts[place] == 0) return;
  unsigned long long at = place == 0 ? 0 : view.pair_ends[place - 1];
  const unsigned long long depth = __float_as_uint(view.splats[place].depth);
  const TileRange rows = view.rows[place], columns = view.columns[place];
  for (int32_t row = rows.begin; row < rows.end; ++row)
    for (int32_t column = columns.begin; column < columns.end; ++column, ++at) {
      const auto tile = static_cast<unsigned long long>(row * view.grid.columns + column);
      view.keys[at] = tile << 32 | depth;
      view.values[at] = place;
    }
}

__global__ void __launch_bounds__(kThreads) baseline_ranges(BaselineView view) {
  const unsigned long long at =
      static_cast<unsigned long long>(blockIdx.x) * kThreads + threadIdx.x;
  if (at >= view.pairs) return;
  const unsigned long long tile = view.sorted_keys[at] >> 32;
  if (at == 0 || view.sorted_keys[at - 1] >> 32 != tile) view.tiles[tile].x = at;
  if (at + 1 == view.pairs || view.sorted_keys[at + 1] >> 32 != tile) view.tiles[tile].y = at + 1;
}

template <bool kLod>
__device__ void baseline_blend(const BaselineSplat& s, float x, float y, RasterPixel& pixel) {
  const float dx = s.x - x, dy = s.y - y;
  const float power = -0.5f * (s.a * dx * dx + s.c * dy * dy) - s.b * dx * dy;
  if (!(power <= 0.0f)) return;  // NaN, too
  float alpha = fminf(kAlphaMax, s.opacity * expf(power));
  if (kLod && s.t != 1.0f) alpha = sibling_alpha(alpha, s.t, s.inverse_k);
  if (alpha < kAlphaThreshold) return;
  const float after = pixel.transmittance * (1.0f - alpha);
  if (after < kTransmittanceEnd) {
    pixel.end();
    return;
  }
  const float weight = alpha * pixel.transmittance;
  pixel.r += s.red * weight, pixel.g += s.green * weight, pixel.b += s.blue * weight;
  if (pixel.transmittance > 0.5f && after <= 0.5f) pixel.depth = s.depth;
  pixel.transmittance = after;
}

template <bool kLod>
__global__ void __launch_bounds__(kThreads)
    baseline_rasterize(BaselineView view, RasterTarget target) {
  static_assert(kThreads == kTile * kTile);
  __shared__ BaselineSplat batch[kThreads];
  const auto columns = static_cast<uint32_t>(view.grid.columns);
  const uint32_t x = blockIdx.x % columns * kTile + threadIdx.x % kTile;
  const uint32_t y = blockIdx.x / columns * kTile + threadIdx.x / kTile;
  const bool inside = x < target.width && y < target.height;
  const float centre_x = static_cast<float>(x) + 0.5f, centre_y = static_cast<float>(y) + 0.5f;
  RasterPixel pixel;
  if (!inside) pixel.end();
  const ulonglong2 list = view.tiles[blockIdx.x];
  for (unsigned long long first = list.x; first < list.y; first += kThreads) {
    if (__syncthreads_and(pixel.ended())) break;
    if (first + threadIdx.x < list.y)
      batch[threadIdx.x] = view.splats[view.sorted_values[first + threadIdx.x]];
    __syncthreads();
    const auto count = static_cast<unsigned>(min(list.y - first, 0ull + kThreads));
    for (unsigned i = 0; i < count && !pixel.ended(); ++i)
      baseline_blend<kLod>(batch[i], centre_x, centre_y, pixel);
  }
  if (inside) write_pixel(target, x, y, pixel);
}

__global__ void __launch_bounds__(kThreads) baseline_count(BaselineView view) {
  uint32_t drawn = 0;
  for (uint32_t place = blockIdx.x * kThreads + threadIdx.x; place < view.places;
       place += gridDim.x * kThreads)
    drawn += view.tile_counts[place] != 0;
  drawn = __reduce_add_sync(kAllLanes, drawn);
  if (lane_in_warp() == 0) atomicAdd(view.splat_count, drawn);
}

template <class Sh>
void launch_project(const BaselineFrame& f) {
  const unsigned blocks = blocks_for(f.places);
  if (f.draws.list.weights != nullptr)
    launch_kernel("baseline_project", baseline_project<Sh, true>, {blocks, kThreads, f.stream}, f);
  else
    launch_kernel("baseline_project", baseline_project<Sh, false>, {blocks, kThreads, f.stream}, f);
}

int key_bits(const TileGrid& grid) {
  int bits = 32;
  for (int64_t tiles = int64_t{grid.columns} * grid.rows - 1; tiles > 0; tiles /= 2) ++bits;
  return bits;
}

struct Widen {
  __device__ unsigned long long operator()(uint32_t count) const { return count; }
};

cudaError_t scan(void* scratch, size_t& bytes, const BaselineView& v, cudaStream_t stream) {
  return cub::DeviceScan::InclusiveSum(scratch, bytes,
                                       thrust::make_transform_iterator(v.tile_counts, Widen{}),
                                       v.pair_ends, v.places, stream);
}
cudaError_t sort(void* scratch, size_t& bytes, const BaselineView& v, cudaStream_t stream) {
  return cub::DeviceRadixSort::SortPairs(scratch, bytes, v.keys, v.sorted_keys, v.values,
                                         v.sorted_values, v.pairs, 0, key_bits(v.grid), stream);
}

}  // namespace

size_t baseline_scratch(const BaselineView& view) {
  size_t scanning = 0, sorting = 0;
  check(scan(nullptr, scanning, view, nullptr), "scratch of baseline_scan");
  check(sort(nullptr, sorting, view, nullptr), "scratch of baseline_sort");
  return scanning > sorting ? scanning : sorting;
}

void launch_baseline_project(const BaselineFrame& f) {
  if (f.places == 0) return;
  with_sh(f.gaussians, [&]<class Sh>() { launch_project<Sh>(f); });
}

void launch_baseline_count(const BaselineFrame& f) {
  check(cudaMemsetAsync(f.view.splat_count, 0, sizeof(uint32_t), f.stream), "baseline_count");
  launch_kernel("baseline_count", baseline_count, {64, kThreads, f.stream}, f.view);
}

void launch_baseline_scan(const BaselineFrame& f) {
  size_t bytes = f.scratch_bytes;
  if (f.view.places != 0) check(scan(f.scratch, bytes, f.view, f.stream), "baseline_scan");
}

void launch_baseline_keys(const BaselineFrame& f) {
  if (f.view.pairs == 0) return;
  launch_kernel("baseline_keys", baseline_keys, {blocks_for(f.view.places), kThreads, f.stream},
                f.view);
}

void launch_baseline_sort(const BaselineFrame& f) {
  size_t bytes = f.scratch_bytes;
  if (f.view.pairs != 0) check(sort(f.scratch, bytes, f.view, f.stream), "baseline_sort");
}

void launch_baseline_rasterize(const BaselineFrame& f, bool siblings, const RasterTarget& target) {
  const BaselineView& v = f.view;
  const auto tiles = static_cast<unsigned>(v.grid.columns * v.grid.rows);
  check(cudaMemsetAsync(v.tiles, 0, tiles * sizeof(ulonglong2), f.stream), "baseline_ranges");
  if (v.pairs != 0)
    launch_kernel("baseline_ranges", baseline_ranges, {blocks_for(v.pairs), kThreads, f.stream}, v);
  if (siblings)
    launch_kernel("baseline_rasterize", baseline_rasterize<true>, {tiles, kThreads, f.stream}, v,
                  target);
  else
    launch_kernel("baseline_rasterize", baseline_rasterize<false>, {tiles, kThreads, f.stream}, v,
                  target);
}

}  // namespace voyager::cuda
