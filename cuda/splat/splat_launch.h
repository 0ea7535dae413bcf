#pragma once
// The kernels of the stages from projection on, launched on a stream. None waits for the host.
#include <cuda_runtime_api.h>

#include "cuda/scene/device_scene.h"
#include "cuda/search/search.h"
#include "cuda/splat/splats.h"
#include "runtime/frame/backend.h"
#include "runtime/stages/project.h"

namespace voyager::cuda {

// What a frame draws of an instance, in the order of ids.
struct DrawView {
  CutList list;            // its nodes null: every Gaussian, by its index
  const uint32_t* ids;     // by place, what breaks ties of depth: 0 to the last place, each
                           // once. Null: the places themselves.
  WeightSource weights{};  // where project_cull finds them

  // Whether it may draw nodes between their parent and themselves.
  VOYAGER_HD bool blends() const { return list.weights != nullptr || weights.weighs(); }
};

// What a frame's kernels share. The first five are an instance's, and projection's alone;
// params are of each eye.
struct SplatFrame {
  uint32_t instance;  // those projected before it in this frame
  GaussianView gaussians;
  DrawView draws;
  ProjectParams params[kMaxEyes];
  RowList rows;  // of its list, those that are looked at
  SplatView splats;
  unsigned multiprocessors;
  cudaStream_t stream;
};

// project_rows.cu. Of an instance's list, the rows of which a Gaussian may reach the image of an
// eye; all, where the list has no bounds. Those behind the splats' room are left out.
RowList launch_rows(const SplatFrame& frame);
// project.cu, project_slots.cu. An instance's splats into slots behind those of the instances
// before it, and into strips of tiles (METHOD §7b): with the α-filter those that its ellipse
// touches, without it its box's. False where the instance has nothing to draw, and so takes no
// number.
bool launch_project(const SplatFrame& frame, bool alpha_filter);
// bin.cu: the (tile, splat) pairs, tile by tile. Those beyond the room are left out.
void launch_bin(const SplatFrame& frame);
// Thread blocks that count for themselves: rows of SplatView::tile_offsets.
unsigned bin_blocks(unsigned multiprocessors);
// sort.cu: each tile's list by depth, then instance, then id.
void launch_sort(const SplatFrame& frame);

// rasterize.cu
struct RasterTarget {
  ColorFormat format;
  void* color;   // tightly packed; null where format is none
  float* depth;  // or null
  uint32_t width, height;
  Vec3f background;
  // In place of color and depth, where they are not 0: an image of another API.
  cudaSurfaceObject_t color_surface, depth_surface;
  bool layered;
  uint32_t layer;

  VOYAGER_HD bool has_depth() const { return depth != nullptr || depth_surface != 0; }
};
struct RasterChoices {
  Exponential exponential;
  bool alpha_filter;
  bool count_pixels;
  bool siblings;     // some t may be below 1
  const float* lut;  // lut_size + 1 entries on the device
  uint32_t lut_size;
  float log_threshold;  // log α*, natural
};
// An eye's image, and how far it may be seen: on the device.
struct RasterEye {
  RasterTarget target;
  DepthLimits limits;
};
// eyes: the frame's.
void launch_rasterize(const SplatFrame& frame, const RasterChoices& choices, const RasterEye* eyes);

}  // namespace voyager::cuda
