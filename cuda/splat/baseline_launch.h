#pragma once
// The kernels of the baseline.
#include <cuda_runtime_api.h>

#include "cuda/splat/splat_launch.h"

namespace voyager::cuda {

struct alignas(16) BaselineSplat {
  float x, y, depth, t;
  float a, b, c, opacity;  // of the inverse covariance [[a, b], [b, c]]
  float red, green, blue, inverse_k;
};

// As kernels take it, by place: those of one instance's list behind those of another's.
struct BaselineView {
  BaselineSplat* splats;
  TileRange* rows;  // of each splat's box; none where it is not drawn
  TileRange* columns;
  uint32_t* tile_counts;
  unsigned long long* pair_ends;           // running sums of tile_counts
  unsigned long long *keys, *sorted_keys;  // tile above depth
  uint32_t *values, *sorted_values;        // places
  ulonglong2* tiles;                       // [first, last) of the sorted pairs
  uint32_t* splat_count;
  TileGrid grid;
  uint32_t places;  // of all instances
  unsigned long long pairs;
};

// What comes first, up to the view, is an instance's, and projection's alone.
struct BaselineFrame {
  uint32_t first, places;  // where its list begins, and how long it is
  GaussianView gaussians;
  DrawView draws;
  ProjectParams params;
  BaselineView view;
  void* scratch;
  size_t scratch_bytes;
  cudaStream_t stream;
};

// Bytes that scanning and sorting want.
size_t baseline_scratch(const BaselineView& view);

void launch_baseline_project(const BaselineFrame& frame);
void launch_baseline_scan(const BaselineFrame& frame);
void launch_baseline_keys(const BaselineFrame& frame);
void launch_baseline_sort(const BaselineFrame& frame);
// How many are drawn, for the statistics: apart from what is timed.
void launch_baseline_count(const BaselineFrame& frame);
// siblings: some t may be below 1.
void launch_baseline_rasterize(const BaselineFrame& frame, bool siblings,
                               const RasterTarget& target);

}  // namespace voyager::cuda
