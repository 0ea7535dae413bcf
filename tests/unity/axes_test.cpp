// A point of a scene is seen through the converted camera where Unity's matrices put it.
#include <gtest/gtest.h>

#include <random>

#include "tests/unity/unity_camera.h"
#include "unity_axes.h"

namespace voyager::test {
namespace unity_axes_test {
namespace {

struct Seen {
  double x, y;  // of the picture, -1 to 1; y grows upwards
  double z;     // along the view axis
};

// By the matrices that Unity hands out.
Seen by_unity(const UnityCamera& camera, const Vector& point) {
  Vector from_camera;
  for (size_t i = 0; i < 3; ++i) from_camera[i] = point[i] - camera.position[i];
  const std::array<float, 16> p = camera.projection();
  const Vector v = {dot(camera.right, from_camera), dot(camera.up, from_camera),
                    -dot(camera.forward, from_camera)};
  return {(static_cast<double>(p[0]) * v[0] + static_cast<double>(p[8]) * v[2]) / -v[2],
          (static_cast<double>(p[5]) * v[1] + static_cast<double>(p[9]) * v[2]) / -v[2], -v[2]};
}

// v turned by the inverse of the unit quaternion q, (x, y, z, w).
Vector turned_back(const double (&q)[4], const Vector& v) {
  const Vector axis = {-q[0], -q[1], -q[2]};
  Vector t = cross(axis, v);
  for (double& each : t) each *= 2;
  const Vector u = cross(axis, t);
  return {v[0] + q[3] * t[0] + u[0], v[1] + q[3] * t[1] + u[1], v[2] + q[3] * t[2] + u[2]};
}

Seen by_voyager(const UnityCamera& camera, const Vector& point) {
  float world[16], lens[16];
  const std::array<float, 16> matrix = camera.camera_to_world(), projection = camera.projection();
  std::copy(matrix.begin(), matrix.end(), world);
  std::copy(projection.begin(), projection.end(), lens);
  const VoyPose pose = voyager_unity::scene_pose(world);
  const VoyFrustum frustum = voyager_unity::frustum(lens);
  const Vector scene = {point[0], -point[1], point[2]};
  const Vector v = turned_back(
      pose.orientation,
      {scene[0] - pose.position[0], scene[1] - pose.position[1], scene[2] - pose.position[2]});
  return {2 * (v[0] / -v[2] - frustum.left) / (frustum.right - frustum.left) - 1,
          2 * (v[1] / -v[2] - frustum.down) / (frustum.up - frustum.down) - 1, -v[2]};
}

TEST(UnityAxes, APointIsSeenWhereUnityPutsIt) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(-3.1, 3.1), place(-20, 20);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const UnityCamera camera = UnityCamera::at({place(random), place(random), place(random)},
                                               angle(random), angle(random), angle(random));
    const Vector point = {place(random), place(random), place(random)};
    const Seen unity = by_unity(camera, point), ours = by_voyager(camera, point);
    EXPECT_NEAR(ours.z, unity.z, 1e-4) << i;
    if (std::abs(unity.x) > 1 || std::abs(unity.y) > 1 || unity.z < 0.3) continue;
    ++compared;
    EXPECT_NEAR(ours.x, unity.x, 1e-4) << i;
    EXPECT_NEAR(ours.y, unity.y, 1e-4) << i;
  }
  EXPECT_GT(compared, 20);
}

}  // namespace
}  // namespace unity_axes_test
}  // namespace voyager::test
