#include "tools/report/slow_paths.h"

#include <gtest/gtest.h>

#include "tests/support/render_scene.h"
#include "tests/support/scene_files.h"

namespace voyager::tools {
namespace slow_paths_test {
namespace {

// Where a point of the world is in the picture.
Vec3d seen(const voyager::Camera& camera, const Vec3d& world) {
  const Vec3d p = camera.world_to_view * (world - camera.eye);
  return {camera.fx * p.x / p.z + camera.cx, camera.fy * p.y / p.z + camera.cy, p.z};
}

TEST(SlowPaths, EachFrameMovesThePictureByAQuarterOfAPixel) {
  const auto scene = test::baked_scene(test::random_cloud(500, 3, 0));
  const FrameInput first = test::frame_input(test::look({0, -5, -60}, {0, 0, 0}, 160, 100), 3);
  const SlowPaths paths = slow_paths(first, *scene, 5);
  ASSERT_EQ(paths.dolly.size(), 5u);
  ASSERT_EQ(paths.turn.size(), 5u);
  const voyager::Camera& start = first.eyes[0].camera;
  const Vec3d middle = start.eye + 40.0 * start.world_to_view.row[2];
  for (size_t i = 0; i < 5; ++i) {
    const double step = 0.25 * static_cast<double>(i);
    const voyager::Camera& turned = paths.turn[i].eyes[0].camera;
    EXPECT_NEAR(seen(turned, middle).x, seen(start, middle).x - step, 1e-3);
    EXPECT_NEAR(seen(turned, middle).y, seen(start, middle).y, 1e-9);
    EXPECT_EQ(turned.eye, start.eye);
  }
  // Half the Gaussians are nearer than the distance at which it is a quarter.
  const voyager::Camera& moved = paths.dolly[1].eyes[0].camera;
  size_t faster = 0, all = 0;
  for (const uint32_t leaf : scene->leaves) {
    const Vec3f& m = scene->gaussians[leaf].mean;
    Vec3d mean{double{m.x}, double{m.y}, double{m.z}};
    const Vec3d at = seen(start, mean);
    if (at.z < start.near_z || at.x < 0 || at.x >= 160 || at.y < 0 || at.y >= 100) continue;
    // To the picture's edge, at its depth.
    const double half = 0.5 * 160 / start.fx * at.z;
    mean = start.eye + at.z * start.world_to_view.row[2] + half * start.world_to_view.row[0];
    faster += seen(moved, mean).x - seen(start, mean).x > 0.25;
    ++all;
  }
  ASSERT_GT(all, 100u);
  EXPECT_NEAR(static_cast<double>(faster) / static_cast<double>(all), 0.5, 0.02);
}

TEST(SlowPaths, LeavesOfDamagedChunksAreLeftOut) {
  auto bytes = test::scene_bytes(test::bake(test::random_cloud(3000, 3, 0)), Quality::lossless);
  bytes[bytes.size() / 2] ^= std::byte{1};
  Workers workers(2);
  const auto scene = load_scene(test::source_of(bytes), std::pmr::get_default_resource(), workers);
  ASSERT_FALSE(scene->damaged.empty());
  const FrameInput first = test::frame_input(test::look({0, -5, -60}, {0, 0, 0}, 160, 100), 3);
  EXPECT_EQ(slow_paths(first, *scene, 2).dolly.size(), 2u);
}

TEST(SlowPaths, WhereNothingIsInThePictureThereIsNoDolly) {
  const auto scene = test::baked_scene(test::random_cloud(50, 3, 0));
  const FrameInput away = test::frame_input(test::look({0, 0, -60}, {0, 0, -100}, 160, 100), 3);
  EXPECT_TRUE(slow_paths(away, *scene, 3).dolly.empty());
  EXPECT_EQ(slow_paths(away, *scene, 3).turn.size(), 3u);
}

}  // namespace
}  // namespace slow_paths_test
}  // namespace voyager::tools
