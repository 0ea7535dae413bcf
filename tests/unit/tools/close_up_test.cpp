// A walk up to a wall of Gaussians and along it.
#include "tools/close_up.h"

#include <gtest/gtest.h>

#include "runtime/cpu/cpu_backend.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_files.h"

namespace voyager::tools {
namespace close_up_test {
namespace {

// Flat splats at z = 5, 8 m wide and high, opaque.
GaussianCloud wall() {
  GaussianCloud cloud = test::random_cloud(41 * 41, 0, 0);
  for (size_t i = 0; i < cloud.size(); ++i) {
    cloud.position[3 * i] = 0.2f * static_cast<float>(i % 41) - 4;
    cloud.position[3 * i + 1] = 0.2f * static_cast<float>(i / 41) - 4;
    cloud.position[3 * i + 2] = 5;
    for (int k = 0; k < 3; ++k)
      cloud.log_scale[3 * i + static_cast<size_t>(k)] = k == 2 ? -7 : -1.6f;
    for (int k = 0; k < 4; ++k) cloud.rotation[4 * i + static_cast<size_t>(k)] = k == 0 ? 1 : 0;
    cloud.opacity[i] = 6;
  }
  return cloud;
}

class CloseUp : public ::testing::Test {
 protected:
  std::vector<Camera> walk(std::span<const Camera> start) {
    const auto backend = create_cpu_backend();
    Workers workers(2);
    return close_up_cameras({*backend, test::baked_scene(wall()), workers}, start, 20);
  }
  // Ahead along z, as captured scenes have it.
  static Camera ahead(double x, double z) {
    return looking({x, 0, z}, {1, 0, 0}, {0, 0, 1}, 160, 90, 100);
  }
};

TEST_F(CloseUp, StopsBeforeTheWallAndFollowsIt) {
  const Camera start = ahead(-1, 0);
  const auto path = walk({&start, 1});
  ASSERT_EQ(path.size(), 20u);
  for (size_t i = 0; i < 20; ++i) {
    const auto& p = path[i].pose.position;
    EXPECT_EQ(path[i].width, 160u);
    EXPECT_NEAR(p[0], i < 10 ? -1 : -1 + 0.1 * static_cast<double>(i - 9), 1e-9);
    if (i > 0) {
      EXPECT_GT(p[2], i < 10 ? path[i - 1].pose.position[2] : 4.6);
    }
    if (i >= 9) {
      EXPECT_NEAR(p[2], 4.7, 0.1) << i;
    }
  }
}

TEST_F(CloseUp, BothEyesMoveAlike) {
  const Camera eyes[] = {ahead(-0.03, 0), ahead(0.03, 0)};
  const auto path = walk(eyes);
  ASSERT_EQ(path.size(), 40u);
  for (size_t i = 0; i < 40; i += 2) {
    EXPECT_NEAR(path[i + 1].pose.position[0] - path[i].pose.position[0], 0.06, 1e-12);
    EXPECT_EQ(path[i + 1].pose.position[2], path[i].pose.position[2]);
  }
}

TEST_F(CloseUp, ThereIsNoneWhereNothingIsAhead) {
  const Camera past = ahead(0, 9);
  EXPECT_TRUE(walk({&past, 1}).empty());
}

}  // namespace
}  // namespace close_up_test
}  // namespace voyager::tools
