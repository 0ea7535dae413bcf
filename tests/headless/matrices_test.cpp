// Frusta and poses from engines' matrices: what a host would have written by hand comes out.
#include <array>
#include <cmath>
#include <random>

#include "hostile.h"

namespace matrices_test {
namespace {

using Matrix = std::array<double, 16>;  // column by column
using Vector = std::array<double, 3>;

class Matrices : public ::testing::Test {
 protected:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
  void expect_refused(VoyResult result, const std::string& part) const {
    EXPECT_EQ(result, VOY_ERROR_INVALID_ARGUMENT) << part;
    EXPECT_NE(voy.message().find(part), std::string::npos) << voy.message();
  }

  const Library voy;
  std::mt19937 random{20};
};

// What an engine may choose.
struct Lens {
  bool looks_along_plus_z, camera_y_up, clip_y_up, minus_one_to_one, reversed, infinite;
};

Matrix projection(const VoyFrustum& f, const Lens& lens) {
  const double ahead = lens.looks_along_plus_z ? 1 : -1, up = lens.camera_y_up ? 1 : -1;
  const double top = (lens.clip_y_up ? 1 : -1) * up;  // of clip y, where the camera's y grows
  const double width = f.right - f.left, height = f.up - f.down;
  const double near = 0.1, far = lens.infinite ? 1e300 : 500;
  double at_near = lens.minus_one_to_one ? -1 : 0, at_far = 1;
  if (lens.reversed) std::swap(at_near, at_far);
  Matrix m{};
  m[0] = 2 / width;
  m[5] = 2 / height * top;
  m[8] = -ahead * (f.right + f.left) / width;
  m[9] = -ahead * (f.up + f.down) / height * top * up;
  m[10] = ahead * (at_far - at_near * near / far) / (1 - near / far);
  m[11] = ahead;
  m[14] = near * (at_near - ahead * m[10]);
  return m;
}

TEST_F(Matrices, AFrustumComesBackFromEveryKindOfProjection) {
  for (int kind = 0; kind < 64; ++kind)
    for (int i = 0; i < 20; ++i) {
      const Lens lens = {(kind & 1) != 0, (kind & 2) != 0,  (kind & 4) != 0,
                         (kind & 8) != 0, (kind & 16) != 0, (kind & 32) != 0};
      VoyFrustum wanted;
      ASSERT_EQ(voy.FrustumFromAngles(between(-1.3, 0.2), between(0.3, 1.3), between(0.1, 1.3),
                                      between(-1.3, 0), &wanted),
                VOY_SUCCESS);
      Matrix m = projection(wanted, lens);
      const double share = between(0.5, 2);  // homogeneous: any multiple is the same projection
      for (double& each : m) each *= share;
      VoyFrustum found = {};
      ASSERT_EQ(voy.FrustumFromProjection(m.data(),
                                          lens.clip_y_up ? VOY_CLIP_Y_UP : VOY_CLIP_Y_DOWN, &found),
                VOY_SUCCESS)
          << voy.message();
      EXPECT_NEAR(found.left, wanted.left, 1e-12) << kind;
      EXPECT_NEAR(found.right, wanted.right, 1e-12) << kind;
      EXPECT_NEAR(found.up, wanted.up, 1e-12) << kind;
      EXPECT_NEAR(found.down, wanted.down, 1e-12) << kind;
    }
}

TEST_F(Matrices, WhatIsNoPerspectiveIsRefused) {
  const Matrix good = projection({-1, 1, 1, -1}, {});
  VoyFrustum f = {1, 2, 3, 4};
  const auto with = [&](size_t element, double value) {
    Matrix m = good;
    m[element] = value;
    return voy.FrustumFromProjection(m.data(), VOY_CLIP_Y_UP, &f);
  };
  for (size_t i = 0; i < 16; ++i)
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL})
      expect_refused(with(i, bad), "matrix[" + std::to_string(i) + "]: found");
  expect_refused(with(11, 0), "not a perspective");
  expect_refused(with(0, -1), "mirrors x");
  expect_refused(with(0, 0), "mirrors x");
  expect_refused(with(5, 0), "factor of y");
  for (const size_t i : {1u, 3u, 4u, 7u, 12u, 13u, 15u}) expect_refused(with(i, 1e-3), "skewed");
  expect_refused(with(0, 1e-7), "frustum.left");
  expect_refused(voy.FrustumFromProjection(nullptr, VOY_CLIP_Y_UP, &f), "matrix");
  expect_refused(voy.FrustumFromProjection(good.data(), VOY_CLIP_Y_UP, nullptr), "frustum");
  for (const int bad : {-1, 2, INT32_MAX})
    expect_refused(voy.FrustumFromProjection(good.data(), bad_enum<VoyClipY>(bad), &f), "clipY");
  EXPECT_EQ(f.up, 3) << "a refused call wrote its output";
}

// The axes of a turned body in a world, column by column.
struct Body {
  Vector axis[3], position;

  Matrix matrix() const {
    Matrix m{};
    for (size_t c = 0; c < 3; ++c) std::copy_n(axis[c].begin(), 3, m.begin() + 4 * c);
    std::copy_n(position.begin(), 3, m.begin() + 12);
    m[15] = 1;
    return m;
  }
  Matrix inverse() const {
    Matrix m{};
    for (size_t r = 0; r < 3; ++r)
      for (size_t c = 0; c < 3; ++c) {
        m[4 * c + r] = axis[r][c];
        m[12 + r] -= axis[r][c] * position[c];
      }
    m[15] = 1;
    return m;
  }
  Vector operator*(const Vector& own) const {
    Vector out = position;
    for (size_t i = 0; i < 3; ++i)
      for (size_t c = 0; c < 3; ++c) out[i] += axis[c][i] * own[c];
    return out;
  }
};

// v turned by the unit quaternion (x, y, z, w), then moved.
Vector placed(const VoyPose& pose, const Vector& v) {
  const auto& [x, y, z, w] = pose.orientation;
  const Vector t = {2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]),
                    2 * (x * v[1] - y * v[0])};
  return {pose.position[0] + v[0] + w * t[0] + y * t[2] - z * t[1],
          pose.position[1] + v[1] + w * t[1] + z * t[0] - x * t[2],
          pose.position[2] + v[2] + w * t[2] + x * t[1] - y * t[0]};
}

class Poses : public Matrices {
 protected:
  Body any_body(bool mirrors) {
    const double a = between(-3, 3), b = between(-3, 3), c = between(-3, 3);
    const double ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b),
                 cc = std::cos(c), sc = std::sin(c), sign = mirrors ? -1 : 1;
    return {{{ca * cb, sa * cb, -sb},
             {ca * sb * sc - sa * cc, sa * sb * sc + ca * cc, cb * sc},
             {sign * (ca * sb * cc + sa * sc), sign * (sa * sb * cc - ca * sc), sign * cb * cc}},
            {between(-1e6, 1e6), between(-50, 50), between(-1e6, 1e6)}};
  }
};

// A point goes where the host's matrix takes it, seen in Voyager's axes before and after.
TEST_F(Poses, APointIsWhereTheMatrixPutsIt) {
  for (const VoyHand hand : {VOY_HAND_RIGHT, VOY_HAND_LEFT})
    for (const bool mirrors : {false, true})
      for (int i = 0; i < 100; ++i) {
        const Body body = any_body(mirrors);
        const double world_z = hand == VOY_HAND_LEFT ? -1 : 1, own_z = mirrors ? -world_z : world_z;
        VoyPose from_world, from_view;
        ASSERT_EQ(voy.PoseFromWorldMatrix(body.matrix().data(), hand, &from_world), VOY_SUCCESS)
            << voy.message();
        ASSERT_EQ(voy.PoseFromViewMatrix(body.inverse().data(), hand, &from_view), VOY_SUCCESS)
            << voy.message();
        const Vector own = {between(-9, 9), between(-9, 9), between(-9, 9)}, wanted = body * own;
        for (const VoyPose& pose : {from_world, from_view}) {
          const Vector found = placed(pose, {own[0], own[1], own_z * own[2]});
          EXPECT_NEAR(found[0], wanted[0], 1e-8);
          EXPECT_NEAR(found[1], wanted[1], 1e-8);
          EXPECT_NEAR(found[2], world_z * wanted[2], 1e-8);
        }
      }
}

// Straight ahead of a camera is -z of its pose, whatever the engine calls it.
TEST_F(Poses, ACameraOfEitherHandLooksAlongMinusZ) {
  const Body left_handed = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};    // looks along +z
  const Body right_handed = {{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}, {0, 0, 0}};  // along its -z
  for (const Body& camera : {left_handed, right_handed}) {
    VoyPose pose;
    ASSERT_EQ(voy.PoseFromWorldMatrix(camera.matrix().data(), VOY_HAND_LEFT, &pose), VOY_SUCCESS);
    const Vector ahead = placed(pose, {0, 0, -1});
    EXPECT_NEAR(ahead[2], -1, 1e-12) << "the world's +z is Voyager's -z";
  }
}

TEST_F(Poses, MatricesInSinglePrecisionAreTaken) {
  for (int i = 0; i < 100; ++i) {
    Matrix m = any_body(false).matrix();
    for (double& each : m) each = static_cast<double>(static_cast<float>(each));
    VoyPose pose;
    EXPECT_EQ(voy.PoseFromWorldMatrix(m.data(), VOY_HAND_RIGHT, &pose), VOY_SUCCESS)
        << voy.message();
  }
}

TEST_F(Poses, WhatIsNoRigidMotionIsRefused) {
  const Matrix good = any_body(false).matrix();
  VoyPose pose = {{7, 7, 7}, {0, 0, 0, 1}};
  const auto with = [&](auto&& change) {
    Matrix m = good;
    change(m);
    const VoyResult view = voy.PoseFromViewMatrix(m.data(), VOY_HAND_LEFT, &pose);
    EXPECT_EQ(voy.PoseFromWorldMatrix(m.data(), VOY_HAND_RIGHT, &pose), view);
    return view;
  };
  for (size_t i = 0; i < 16; ++i)
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL})
      expect_refused(with([&](Matrix& m) { m[i] = bad; }), "matrix[" + std::to_string(i) + "]");
  for (const size_t i : {3u, 7u, 11u, 15u})
    expect_refused(with([&](Matrix& m) { m[i] = 0.5; }), "matrix[" + std::to_string(i) + "]");
  expect_refused(with([](Matrix& m) { m[13] = 1e18; }), "matrix[13]");
  const auto scale = [](Matrix& m, size_t column, double by) {
    for (size_t r = 0; r < 3; ++r) m[4 * column + r] *= by;
  };
  for (const double by : {0.0, 0.5, 1.001, 1e300})
    for (size_t column = 0; column < 3; ++column)
      expect_refused(with([&](Matrix& m) { scale(m, column, by); }),
                     "column " + std::to_string(column) + ": found");
  expect_refused(with([](Matrix& m) {
                   const double angle = 0.01;  // of the second axis towards the first
                   for (size_t r = 0; r < 3; ++r)
                     m[4 + r] = std::cos(angle) * m[4 + r] + std::sin(angle) * m[r];
                 }),
                 "shears");
  expect_refused(voy.PoseFromWorldMatrix(nullptr, VOY_HAND_RIGHT, &pose), "matrix");
  expect_refused(voy.PoseFromViewMatrix(good.data(), VOY_HAND_RIGHT, nullptr), "pose");
  for (const int bad : {-1, 2, INT32_MAX})
    expect_refused(voy.PoseFromWorldMatrix(good.data(), bad_enum<VoyHand>(bad), &pose),
                   "worldHand");
  EXPECT_EQ(pose.position[0], 7) << "a refused call wrote its output";
}

}  // namespace
}  // namespace matrices_test
