#pragma once
// What interpolation reads beside the Gaussians (METHOD §4), on the device: shared by the views
// of a scene that draw a cut. A scene of which every leaf is drawn has none of it.
#include "cuda/device/buffer.h"
#include "cuda/scene/gaussian_view.h"
#include "runtime/frame/scene.h"

namespace voyager::cuda {

class DeviceParents {
 public:
  // The scene has a tree, and is resident.
  explicit DeviceParents(const Scene& scene);

  void add_to(GaussianView& gaussians) const;
  // Bytes of the arrays that the constructor makes for such a scene, without gaps between them.
  static uint64_t bytes(const Scene& scene);

 private:
  // A parent a family, and which family a node is of.
  Buffer<uint32_t> parents_;
  Buffer<RunBlock> families_;
  // A coded scene has these in its shapes.
  Buffer<float> opacities_;
  Buffer<uint8_t> node_codes_;
  Buffer<uint32_t> child_counts_;
  // Of a coded scene.
  Buffer<LargeFamily> large_families_;
  Buffer<uint32_t> large_family_count_;
};

}  // namespace voyager::cuda
