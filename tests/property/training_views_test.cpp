// Where a scene is looked at from while its nodes learn.
#include "runtime/optimize/training_views.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "tests/support/baked_city.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_clouds.h"

namespace voyager::training_views_test {
namespace {

TEST(TrainingViews, FourCutsOfAViewShareItsTruth) {
  const BakedScene baked = test::baked_city(200);
  const TrainingViews views(baked, {baked.leaves.size(), 0, 0});
  for (uint32_t k = 0; k < 12; ++k) {
    const TrainingView found = views.picture(k);
    EXPECT_EQ(truth_of(found), truth_of(views(k / 4)));
    EXPECT_GE(found.tau, 0.75);
    EXPECT_LE(found.tau, 15);
    if (k % 4 != 0) {
      EXPECT_GT(found.tau, views.picture(k - 1).tau);
    }
  }
}

// Up to half of the views are from near a camera that has in its picture what they look at, by
// turns with the others, which are those that there are without cameras.
TEST(TrainingViews, CamerasGuideHalfOfTheViews) {
  const BakedScene baked = test::baked_city(2000);
  const LookedAt looked_at{baked.leaves.size(), 0, 0};
  const TrainingViews alone(baked, looked_at);
  std::vector<TrainingCamera> cameras;
  for (uint32_t k = 5000; k < 5010; ++k) {
    const Camera c = alone(k).camera;
    cameras.push_back({c.eye, c.world_to_view, c.fx, c.fy, c.cx, c.cy,
                       static_cast<uint32_t>(c.width), static_cast<uint32_t>(c.height)});
  }
  const TrainingViews guided(baked, looked_at, cameras);
  constexpr uint32_t kViews = 1000;
  uint32_t from_cameras = 0, in_a_row = 0;
  for (uint32_t k = 0; k < kViews; ++k) {
    const Camera found = guided(k).camera, other = alone(k).camera;
    if (found.eye == other.eye) {
      EXPECT_EQ(found.world_to_view, other.world_to_view);
      EXPECT_EQ(guided.distance(k), alone.distance(k));
      in_a_row = 0;
      continue;
    }
    ++from_cameras;
    EXPECT_LE(++in_a_row, 2u);
    const Vec3d target = found.eye + guided.distance(k) * found.world_to_view.row[2];
    const Vec3d moved = target - (other.eye + alone.distance(k) * other.world_to_view.row[2]);
    EXPECT_LT(dot(moved, moved), 1e-12);
    EXPECT_TRUE(std::any_of(cameras.begin(), cameras.end(), [&](const TrainingCamera& c) {
      const Vec3d seen = c.world_to_view * (target - found.eye);
      return seen.z > 0 && std::fabs(seen.x) * c.fx <= seen.z * c.cx * 1.000001 &&
             std::fabs(seen.y) * c.fy <= seen.z * c.cy * 1.000001;
    }));
  }
  EXPECT_GT(from_cameras, kViews / 4);
  EXPECT_LE(from_cameras, kViews / 2 + kViews / 100);
}

// What is up: −y, but where a scene is flat along z.
TEST(TrainingViews, AFlatSceneIsLookedAtFromAboveAndARoundOneFromBelowToo) {
  const auto rises = [](size_t flat_axis, const Vec3d& up) {
    GaussianCloud cloud = test::specks(500, 6, 0);
    for (size_t i = 0; i < cloud.size(); ++i)
      if (flat_axis < 3) cloud.position[3 * i + flat_axis] *= 0.1f;
    const BakedScene baked = test::bake(cloud);
    const TrainingViews views(baked, {baked.leaves.size(), 0, 0});
    std::pair<double, double> found{1, -1};
    for (uint32_t k = 0; k < 256; ++k) {
      const double rise = -dot(views(k).camera.world_to_view.row[2], up);
      found = {std::min(found.first, rise), std::max(found.second, rise)};
    }
    return found;
  };
  for (const auto& [flat_axis, up, lowest] : {std::tuple{size_t{1}, Vec3d{0, -1, 0}, -0.05},
                                              {size_t{2}, Vec3d{0, 0, 1}, -0.05},
                                              {size_t{3}, Vec3d{0, -1, 0}, -0.5}}) {
    const auto [least, most] = rises(flat_axis, up);
    EXPECT_GE(least, lowest - 1e-9) << flat_axis;
    EXPECT_LT(least, lowest + 0.05) << flat_axis;
    EXPECT_GT(most, 0.95) << flat_axis;
  }
}

}  // namespace
}  // namespace voyager::training_views_test
