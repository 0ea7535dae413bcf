#pragma once
// Scenes whose blocks have footprints of their own (METHOD §12).
#include <vector>

#include "runtime/lod/build.h"
#include "runtime/scene/native_pixel.h"
#include "tests/support/test_support.h"
#include "tests/support/tree_rules.h"

namespace voyager::test {

// Looks along z, its axes the world's; 90° wide.
inline TrainingCamera training_camera(const Vec3d& position, double focal = 500) {
  const auto side = static_cast<uint32_t>(2 * focal);
  return {position, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, focal, focal, focal, focal, side, side};
}

// Of both kinds, in blocks of 16.
inline constexpr TreeRule kMixedRules[] = {kSmallBlocks,
                                           {.kind = TreeKind::hierarchicalgs, .block = 16}};

// Right before random_cloud(), so that depths within it differ by a factor of ten.
inline std::vector<TrainingCamera> close_camera() {
  return {training_camera({0, 0, -12.5}, 100)};
}

inline BakedScene bake_by_cameras(GaussianCloud cloud, const std::vector<TrainingCamera>& cameras,
                                  const TreeRule& rule = kSmallBlocks) {
  Workers workers;
  const NativePixel found = native_pixel(cameras, cloud);
  cloud.native = found.scale();
  const int unseen = cloud.native.level_of(found.median);
  return build_tree(std::move(cloud), workers, {}, rule, {cameras, unseen});
}

}  // namespace voyager::test
