#include "cuda/scene/device_parents.h"

#include <vector>

#include "cuda/device/upload_made.h"
#include "runtime/frame/node_links.h"
#include "runtime/frame/scene_gaussians.h"

namespace voyager::cuda {
namespace {

struct Families {
  std::vector<RunBlock> blocks;
  std::vector<uint32_t> parents;
};

Families families_of(const std::pmr::vector<uint32_t>& parent) {
  Families found{std::vector<RunBlock>((parent.size() + 31) / 32), {}};
  for (size_t n = 0; n < parent.size(); ++n) {
    if (n != 0 && parent[n] == parent[n - 1]) continue;
    found.blocks[n / 32].starts |= 1u << n % 32;
    found.parents.push_back(parent[n]);
  }
  number_runs(found.blocks);
  return found;
}

}  // namespace

DeviceParents::DeviceParents(const Scene& scene) {
  const Families families = families_of(scene.tree.parent);
  const bool coded = is_coded(scene);
  allocate_together(ToAllocate{parents_, families.parents.size()},
                    ToAllocate{families_, families.blocks.size()},
                    ToAllocate{opacities_, scene.gaussians.size()},
                    ToAllocate{node_codes_, footprints_differ(scene) ? 0 : scene.node_code.size()},
                    ToAllocate{child_counts_, coded ? 0 : scene.tree.parent.size()},
                    ToAllocate{large_families_, coded ? scene.large_families.size() : 0},
                    ToAllocate{large_family_count_, coded ? size_t{1} : 0});
  upload<uint32_t>(families.parents, parents_);
  upload<RunBlock>(families.blocks, families_);
  upload_made(opacities_, [&](size_t i) { return scene.gaussians[i].opacity; });
  if (node_codes_.size() != 0) upload<uint8_t>(scene.node_code, node_codes_);
  if (coded) {
    const auto count = static_cast<uint32_t>(scene.large_families.size());
    upload<LargeFamily>(scene.large_families, large_families_);
    upload<uint32_t>({&count, 1}, large_family_count_);
    return;
  }
  const NodeLinks links = node_links(scene);
  upload_made(child_counts_, [&](size_t i) { return links.children(static_cast<uint32_t>(i)); });
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
