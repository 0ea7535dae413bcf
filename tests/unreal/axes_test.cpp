// A point of the world is seen through the converted camera where Unreal's matrices put it.
#include <gtest/gtest.h>

#include <random>

#include "VoyagerAxes.h"
#include "tests/unreal/unreal_camera.h"

namespace voyager::test {
namespace unreal_axes_test {
namespace {

struct Seen {
  double x, y;   // of the picture, -1 to 1; y grows upwards
  double z;      // metres along the view axis
  double depth;  // what the depth buffer holds
};

double along(const FVector& a, const FVector& b) {
  return a.X * b.X + a.Y * b.Y + a.Z * b.Z;
}

// Row vectors times Unreal's matrices.
Seen by_unreal(const UnrealCamera& camera, const FVector& point) {
  const FVector d(point.X - camera.position.X, point.Y - camera.position.Y,
                  point.Z - camera.position.Z);
  const double v[4] = {along(d, camera.right), along(d, camera.up), along(d, camera.forward), 1};
  const FMatrix p = camera.projection();
  double clip[4] = {};
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) clip[column] += v[row] * p.M[row][column];
  return {clip[0] / clip[3], clip[1] / clip[3], v[2] / 100, clip[2] / clip[3]};
}

// The point in the scene, through Voyager's pose and frustum.
Seen by_voyager(const FVoyagerCamera& camera, const FVector& point, const FVector& origin) {
  const double d[3] = {(point.Y - origin.Y) / 100 - camera.Pose.position[0],
                       -(point.Z - origin.Z) / 100 - camera.Pose.position[1],
                       (point.X - origin.X) / 100 - camera.Pose.position[2]};
  const double(&q)[4] = camera.Pose.orientation;
  const auto cross = [&](const double(&b)[3], double(&out)[3]) {  // with the inverse's axis
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      out[i] = -q[j] * b[k] + q[k] * b[j];
    }
  };
  double t[3], u[3], v[3];
  cross(d, t);
  for (double& each : t) each *= 2;
  cross(t, u);
  for (int i = 0; i < 3; ++i) v[i] = d[i] + q[3] * t[i] + u[i];
  const VoyFrustum& f = camera.Frustum;
  const double z = -v[2], a = camera.NearZ, b = camera.FarZ;
  return {2 * (v[0] / z - f.left) / (f.right - f.left) - 1,
          2 * (v[1] / z - f.down) / (f.up - f.down) - 1, z,
          std::isinf(b) ? a / z : a * (b - z) / (z * (b - a))};
}

Seen seen(const UnrealCamera& camera, const FVector& point, const FVector& origin) {
  return by_voyager(
      MakeVoyagerCamera(camera.position, camera.view_to_world(), camera.projection(), origin),
      point, origin);
}

// Ten thousand kilometres from the world's origin, where floats are metres apart.
TEST(UnrealAxes, APointIsSeenWhereUnrealPutsIt) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(-3.1, 3.1), place(-2000, 2000);
  const FVector origin(1e9, -1e9, 3e8);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto somewhere = [&] {
      return FVector(origin.X + place(random), origin.Y + place(random), origin.Z + place(random));
    };
    UnrealCamera camera =
        UnrealCamera::at(somewhere(), angle(random), angle(random), angle(random));
    if (i % 2) camera.far_plane = 5000;
    const FVector point = somewhere();
    const Seen unreal = by_unreal(camera, point), ours = seen(camera, point, origin);
    EXPECT_NEAR(ours.z, unreal.z, 1e-6) << i;
    if (std::abs(unreal.x) > 1 || std::abs(unreal.y) > 1 || unreal.z < 0.3) continue;
    ++compared;
    EXPECT_NEAR(ours.x, unreal.x, 1e-6) << i;
    EXPECT_NEAR(ours.y, unreal.y, 1e-6) << i;
    EXPECT_NEAR(ours.depth, unreal.depth, 1e-6) << i;
  }
  EXPECT_GT(compared, 20);
}

TEST(UnrealAxes, AheadIsAheadAndLeftIsLeftAndUpIsUp) {
  const FVector origin(500, 0, 0);
  const UnrealCamera camera = UnrealCamera::at({100, 200, 300}, 0, 0, 0);
  const Seen ahead = seen(camera, {1100, 200, 300}, origin);
  EXPECT_NEAR(ahead.z, 10, 1e-9) << "1000 cm along x";
  EXPECT_NEAR(ahead.x, 0.7 / 0.6 - 1, 1e-9);
  EXPECT_LT(seen(camera, {1100, 100, 300}, origin).x, ahead.x) << "y is to the right";
  EXPECT_GT(seen(camera, {1100, 200, 400}, origin).y, ahead.y) << "z is up";
  EXPECT_LT(seen(camera, {-900, 200, 300}, origin).z, 0) << "behind";
}

}  // namespace
}  // namespace unreal_axes_test
}  // namespace voyager::test
