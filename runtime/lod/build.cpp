#include "runtime/lod/build.h"

#include <algorithm>
#include <string>

#include "runtime/base/error.h"
#include "runtime/lod/find_layout.h"
#include "runtime/lod/levels.h"
#include "runtime/scene/sanitise.h"
#include "runtime/scene/scale_histogram.h"

namespace voyager {
namespace {

[[noreturn]] void refuse(size_t gaussian, const char* what, float found, const char* expected) {
  throw Error(ErrorCode::refused_input, "Gaussian " + std::to_string(gaussian) + ": " + what +
                                            " is " + std::to_string(found) + ", expected " +
                                            expected);
}

void check_means(const GaussianCloud& cloud, const std::array<double, 3>& origin) {
  for (size_t i = 0; i < cloud.size(); ++i) check_mean(i, local_mean(cloud, i, origin));
}

void check_scales(const GaussianCloud& cloud) {
  for (size_t i = 0; i < cloud.log_scale.size(); ++i)
    if (!(cloud.log_scale[i] >= kMinLogScale && cloud.log_scale[i] <= kMaxLogScale))
      refuse(i / 3, "a log scale", cloud.log_scale[i], "ln 1e-9 to ln 1e6");
}

}  // namespace

void check_count(uint64_t gaussians) {
  if (gaussians > kMaxGaussians)
    throw Error(ErrorCode::refused_input, std::to_string(gaussians) +
                                              " Gaussians, expected at most " +
                                              std::to_string(kMaxGaussians));
}

void check_mean(size_t gaussian, const Vec3f& mean) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::fabs(mean[axis]) < kMaxCoordinate))
      refuse(gaussian, "a position", mean[axis], "a magnitude below 1e18 m");
}

// The root has the smallest footprint of all.
int footprint_levels(const BakedScene& baked) {
  return baked.node_code.empty() ? 1 : 1 + footprint_level_of(baked.node_code[0]);
}

BakedScene build_tree(GaussianCloud cloud, Workers& workers, const Progress& progress,
                      const TreeRule& rule, const BlockFootprints& footprints) {
  const FloatingPointMode mode;
  check_count(cloud.size());
  std::pmr::memory_resource* memory = cloud.position.get_allocator().resource();
  check_means(cloud, {0, 0, 0});
  check_scales(cloud);
  const std::array<double, 3> origin = scene_origin(cloud);
  check_means(cloud, origin);
  cloud.native = known_scale(cloud);
  BakedScene baked{std::move(cloud),
                   GaussianCloud(memory),
                   origin,
                   LodTree(memory),
                   std::pmr::vector<uint32_t>(memory),
                   std::pmr::vector<uint8_t>(memory),
                   rule.kind,
                   {},
                   false};

  const std::vector<uint32_t> levels = lay_out_scene(
      find_layout(baked.leaves, baked.origin, rule, workers, progress, footprints), baked);
  summarise_levels(levels, baked, workers, progress);
  align_levels(levels, baked, workers, progress);
  baked.leaves.native.levels = baked.merged.native.levels = footprint_levels(baked);
  return baked;
}

}  // namespace voyager
