// What a camera of a file asks of a view.
#include "tools/frame_path.h"

#include <gtest/gtest.h>

namespace voyager::tools {
namespace frame_path_test {
namespace {

Camera camera_of(double x, double y, double z, double w) {
  Camera camera{};
  camera.pose = {{1, 2, 3}, {x, y, z, w}};
  camera.width = 640;
  camera.height = 480;
  camera.fx = 700;
  camera.fy = 710;
  camera.cx = 300;
  camera.cy = 250;
  return camera;
}

void expect_row(const Vec3d& row, const Vec3d& expected) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(row[i], expected[i], 1e-15) << i;
}

TEST(FramePath, AxesAreRightDownForward) {
  const auto frame = frame_input(camera_of(0, 0, 0, 1), 3);  // OpenXR's identity looks along -z
  expect_row(frame.eyes[0].camera.world_to_view.row[0], {1, 0, 0});
  expect_row(frame.eyes[0].camera.world_to_view.row[1], {0, -1, 0});
  expect_row(frame.eyes[0].camera.world_to_view.row[2], {0, 0, -1});

  const double half = std::sqrt(0.5);  // a quarter turn to the left, about y
  const auto turned = frame_input(camera_of(0, half, 0, half), 3);
  expect_row(turned.eyes[0].camera.world_to_view.row[0], {0, 0, -1});
  expect_row(turned.eyes[0].camera.world_to_view.row[1], {0, -1, 0});
  expect_row(turned.eyes[0].camera.world_to_view.row[2], {-1, 0, 0});
}

TEST(FramePath, IntrinsicsAreTheFilesOwn) {
  const auto frame = frame_input(camera_of(0, 0, 0, 2), 6);
  EXPECT_EQ(frame.tau, 6);
  EXPECT_EQ(frame.eyes[0].camera.eye.y, 2);
  EXPECT_EQ(frame.eyes[0].camera.width, 640u);
  EXPECT_EQ(frame.eyes[0].camera.height, 480u);
  EXPECT_NEAR(frame.eyes[0].camera.fx, 700, 1e-9);
  EXPECT_NEAR(frame.eyes[0].camera.fy, 710, 1e-9);
  EXPECT_NEAR(frame.eyes[0].camera.cx, 300, 1e-9);
  EXPECT_NEAR(frame.eyes[0].camera.cy, 250, 1e-9);
}

TEST(FramePath, IndicesAreSpreadFromFirstToLast) {
  EXPECT_EQ(spread_indices(4, 8), (std::vector<size_t>{0, 1, 2, 3}));
  EXPECT_EQ(spread_indices(100, 4), (std::vector<size_t>{0, 33, 66, 99}));
  EXPECT_EQ(spread_indices(1, 8), (std::vector<size_t>{0}));
  EXPECT_EQ(spread_indices(9, 1), (std::vector<size_t>{0}));
  EXPECT_TRUE(spread_indices(0, 8).empty());
}

}  // namespace
}  // namespace frame_path_test
}  // namespace voyager::tools
