#include "cuda/scene/device_parents.h"

#include "cuda/device/upload_made.h"
#include "runtime/frame/scene_gaussians.h"

namespace voyager::cuda {

DeviceParents::DeviceParents(const Scene& scene)
    : opacities_(upload_made<float>(scene.gaussians.size(),
                                    [&](size_t i) { return scene.gaussians[i].opacity; })),
      node_codes_(footprints_differ(scene) ? Buffer<uint8_t>()
                                           : upload(std::span<const uint8_t>(scene.node_code))),
      parents_(upload(std::span<const uint32_t>(scene.tree.parent))),
      child_counts_(upload_made<uint32_t>(scene.tree.parent.size(), [&](size_t i) {
        return scene.child_count.empty() ? scene.tree.records[i].child_count : scene.child_count[i];
      })) {}

void DeviceParents::add_to(GaussianView& gaussians) const {
  gaussians.opacities = opacities_.data();
  if (gaussians.node_codes == nullptr) gaussians.node_codes = node_codes_.data();
  gaussians.parents = parents_.data();
  gaussians.child_counts = child_counts_.data();
}

uint64_t DeviceParents::bytes(const Scene& scene) {
  const size_t code = footprints_differ(scene) ? 0 : sizeof(uint8_t),
               own = is_coded(scene) ? 0 : sizeof(float) + code;
  return scene.node_count * (own + 2 * sizeof(uint32_t));
}

}  // namespace voyager::cuda
