// Where `voyager render` looks from when no cameras are given.
#include "tools/default_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::default_camera_test {
namespace {

using tools::Camera;
using tools::camera_around;
using namespace voyager::test;

// A block of a city, 200 x 30 x 100 m around (500, 0, -40).
std::vector<Vec3d> block() {
  std::vector<Vec3d> positions;
  for (int x = 0; x <= 20; ++x)
    for (int y = 0; y <= 6; ++y)
      for (int z = 0; z <= 20; ++z)
        positions.push_back({400.0 + 10 * x, -15.0 + 5 * y, -90.0 + 5 * z});
  return positions;
}

// In pixels, and how far before the camera.
Vec3d seen(const Camera& camera, const Vec3d& p) {
  const double* q = camera.pose.orientation;
  const Mat3d axes = rotation(Quatd{q[3], q[0], q[1], q[2]});  // columns: right, up, backward
  const double* eye = camera.pose.position;
  const Vec3d d = p - Vec3d{eye[0], eye[1], eye[2]};
  const auto along = [&](int i) {
    return dot(Vec3d{axes.row[0][i], axes.row[1][i], axes.row[2][i]}, d);
  };
  const double depth = -along(2);
  return {camera.cx + camera.fx * along(0) / depth, camera.cy - camera.fy * along(1) / depth,
          depth};
}

TEST(DefaultCamera, SeesTheWholeSceneFromAboveAndFillsThePicture) {
  const Camera camera = camera_around(block());
  EXPECT_EQ(camera.width, 1280u);
  EXPECT_EQ(camera.height, 720u);
  EXPECT_LT(camera.pose.position[1], -30);  // up is -y
  double left = 1e9, right = -1e9;
  for (const Vec3d& p : block()) {
    const Vec3d at = seen(camera, p);
    EXPECT_GT(at.z, 1);
    EXPECT_TRUE(at.x >= 0 && at.x <= 1280 && at.y >= 0 && at.y <= 720) << at.x << " " << at.y;
    left = std::min(left, at.x);
    right = std::max(right, at.x);
  }
  EXPECT_GT(right - left, 640);
}

// One Gaussian in a hundred that lies kilometres away, as captures have them.
TEST(DefaultCamera, StraysChangeLittle) {
  std::vector<Vec3d> positions = block();
  for (size_t i = 0; i < positions.size(); i += 100)
    positions[i] = {1e5 * (static_cast<double>(i % 3) - 1), -1e6, 1e7};
  const Camera expected = camera_around(block()), found = camera_around(positions);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(found.pose.position[i], expected.pose.position[i], 15) << i;
}

// Files of one scene, whose writers ordered it each in their way.
TEST(DefaultCamera, DoesNotDependOnTheOrder) {
  const GaussianCloud cloud = random_cloud(10'000, 1, 0);
  GaussianCloud turned = cloud;
  for (size_t i = 0; i < cloud.size(); ++i)
    std::copy_n(&cloud.position[3 * i], 3, &turned.position[3 * (cloud.size() - 1 - i)]);
  const TempFolder folder;
  std::vector<Camera> cameras;
  for (const GaussianCloud& order : {cloud, turned}) {
    const Bytes bytes = ply_of(order);
    const std::string path = folder.file("scene.ply");
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
    cameras.push_back(tools::default_camera(path));
  }
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(cameras[0].pose.position[i], cameras[1].pose.position[i]) << i;
}

TEST(DefaultCamera, StandsSomewhereWithoutGaussians) {
  const Camera camera = camera_around({});
  for (const double x : camera.pose.position) EXPECT_TRUE(std::isfinite(x));
}

}  // namespace
}  // namespace voyager::default_camera_test
