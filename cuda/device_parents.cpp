#include "cuda/device_parents.h"

#include "cuda/upload_made.h"

namespace voyager::cuda {

DeviceParents::DeviceParents(const Scene& scene)
    : opacities_(upload_made<float>(scene.gaussians.size(),
                                    [&](size_t i) { return scene.gaussians[i].opacity; })),
      axis_codes_(upload(std::span<const uint8_t>(scene.axis_code))),
      parents_(upload(std::span<const uint32_t>(scene.tree.parent))),
      child_counts_(upload_made<uint32_t>(
          scene.tree.size(), [&](size_t i) { return scene.tree.records[i].child_count; })) {}

void DeviceParents::add_to(GaussianView& gaussians) const {
  gaussians.opacities = opacities_.data();
  gaussians.axis_codes = axis_codes_.data();
  gaussians.parents = parents_.data();
  gaussians.child_counts = child_counts_.data();
}

uint64_t DeviceParents::bytes(const Scene& scene) {
  return scene.node_count * (sizeof(float) + sizeof(uint8_t) + 2 * sizeof(uint32_t));
}

}  // namespace voyager::cuda
