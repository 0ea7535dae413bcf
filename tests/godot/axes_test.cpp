// A point of a scene is seen through the converted camera where Godot's matrices put it.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "godot_axes.h"
#include "tests/godot/godot_camera.h"

namespace voyager::test {
namespace godot_axes_test {
namespace {

struct Seen {
  double x, y;  // of the picture, -1 to 1; y grows upwards
  double z;     // along the view axis
};

Seen by_godot(const GodotCamera& camera, const Vector& point) {
  Vector d;
  for (size_t i = 0; i < 3; ++i) d[i] = point[i] - camera.position[i];
  const std::array<float, 16> p = camera.projection();
  const Vector v = {dot(camera.right, d), dot(camera.up, d), dot(camera.back, d)};
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

Seen by_voyager(const GodotCamera& camera, const Vector& point) {
  voyager_godot::Transform transform;
  voyager_godot::Projection projection;
  std::ranges::copy(camera.transform(), transform);
  std::ranges::copy(camera.projection(), projection);
  const VoyPose pose = voyager_godot::scene_pose(transform);
  const VoyFrustum frustum = voyager_godot::frustum(projection);
  const Vector v = turned_back(
      pose.orientation,
      {point[0] - pose.position[0], -point[1] - pose.position[1], -point[2] - pose.position[2]});
  return {2 * (v[0] / -v[2] - frustum.left) / (frustum.right - frustum.left) - 1,
          2 * (v[1] / -v[2] - frustum.down) / (frustum.up - frustum.down) - 1, -v[2]};
}

TEST(GodotAxes, APointIsSeenWhereGodotPutsIt) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(-3.1, 3.1), place(-20, 20);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const GodotCamera camera = GodotCamera::at({place(random), place(random), place(random)},
                                               angle(random), angle(random), angle(random));
    const Vector point = {place(random), place(random), place(random)};
    const Seen godot = by_godot(camera, point), ours = by_voyager(camera, point);
    EXPECT_NEAR(ours.z, godot.z, 1e-4) << i;
    if (std::abs(godot.x) > 1 || std::abs(godot.y) > 1 || godot.z < 0.3) continue;
    ++compared;
    EXPECT_NEAR(ours.x, godot.x, 1e-4) << i;
    EXPECT_NEAR(ours.y, godot.y, 1e-4) << i;
  }
  EXPECT_GT(compared, 20);
}

TEST(GodotAxes, AheadIsAheadAndLeftIsLeftAndUpIsUp) {
  const GodotCamera camera = GodotCamera::at({1, 2, 3}, 0, 0, 0);
  const Seen ahead = by_voyager(camera, {1, 2, -7});
  EXPECT_NEAR(ahead.z, 10, 1e-9) << "along -z";
  EXPECT_LT(by_voyager(camera, {0, 2, -7}).x, ahead.x);
  EXPECT_GT(by_voyager(camera, {1, 3, -7}).y, ahead.y);
  EXPECT_LT(by_voyager(camera, {1, 2, 13}).z, 0) << "behind";
}

TEST(GodotAxes, TheNearPlaneIsThatOfTheProjection) {
  GodotCamera camera = GodotCamera::at({0, 0, 0}, 0, 0, 0);
  camera.near_z = 0.05;
  camera.far_z = 4000;
  voyager_godot::Projection projection;
  std::ranges::copy(camera.projection(), projection);
  EXPECT_NEAR(voyager_godot::near_plane(projection), 0.05, 1e-6);
  EXPECT_TRUE(voyager_godot::is_perspective(projection));
  projection[11] = 0;
  EXPECT_FALSE(voyager_godot::is_perspective(projection));
}

}  // namespace
}  // namespace godot_axes_test
}  // namespace voyager::test
