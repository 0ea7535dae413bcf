#include "cuda/scene/device_parents.h"

#include <vector>

#include "cuda/device/upload_made.h"
#include "runtime/frame/node_links.h"
#include "runtime/frame/scene_gaussians.h"

namespace voyager::cuda {

DeviceParents::DeviceParents(const Scene& scene)
    : opacities_(upload_made<float>(scene.gaussians.size(),
                                    [&](size_t i) { return scene.gaussians[i].opacity; })),
      node_codes_(footprints_differ(scene) ? Buffer<uint8_t>()
                                           : upload(std::span<const uint8_t>(scene.node_code))) {
  set_families(scene.tree.parent);
  if (is_coded(scene)) {
    const auto count = static_cast<uint32_t>(scene.large_families.size());
    large_families_ = upload(std::span<const LargeFamily>(scene.large_families));
    large_family_count_ = upload(std::span<const uint32_t>(&count, 1));
    return;
  }
  const NodeLinks links = node_links(scene);
  child_counts_ = upload_made<uint32_t>(
      scene.tree.parent.size(), [&](size_t i) { return links.children(static_cast<uint32_t>(i)); });
}

void DeviceParents::set_families(const std::pmr::vector<uint32_t>& parent) {
  std::vector<RunBlock> blocks((parent.size() + 31) / 32);
  std::vector<uint32_t> parents;
  for (size_t n = 0; n < parent.size(); ++n) {
    if (n != 0 && parent[n] == parent[n - 1]) continue;
    blocks[n / 32].starts |= 1u << n % 32;
    parents.push_back(parent[n]);
  }
  number_runs(blocks);
  parents_ = upload(std::span<const uint32_t>(parents));
  families_ = upload(std::span<const RunBlock>(blocks));
}

void DeviceParents::add_to(GaussianView& gaussians) const {
  gaussians.opacities = opacities_.data();
  if (gaussians.node_codes == nullptr) gaussians.node_codes = node_codes_.data();
  gaussians.parents = {parents_.data(), families_.data()};
  gaussians.child_counts = child_counts_.data();
  gaussians.large_families = large_families_.data();
  gaussians.large_family_count = large_family_count_.data();
}

// The root is of a family of its own.
uint64_t DeviceParents::bytes(const Scene& scene) {
  const uint64_t families = scene.node_count - scene.leaf_count + 1;
  const uint64_t links =
      families * sizeof(uint32_t) + (scene.node_count + 31) / 32 * sizeof(RunBlock);
  if (is_coded(scene))
    return links + scene.large_families.size() * sizeof(LargeFamily) + sizeof(uint32_t);
  const size_t code = footprints_differ(scene) ? 0 : sizeof(uint8_t);
  return links + scene.node_count * (sizeof(float) + code + sizeof(uint32_t));
}

}  // namespace voyager::cuda
