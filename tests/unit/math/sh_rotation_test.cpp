#include "runtime/math/sh_rotation.h"

#include <gtest/gtest.h>

#include <random>

#include "runtime/math/affine.h"
#include "tests/support/transforms.h"

namespace voyager::sh_rotation_test {
namespace {

const std::vector<Mat3d>& turns() {
  static const std::vector<Mat3d> all = {
      kIdentity,
      test::turn(0.9, 0.1, -0.3, 0.2),
      test::turn(0, 1, 0, 0),
      test::turn(0.1, -0.7, 0.6, 0.3),
      test::diagonal(-1, 1, 1),
      test::diagonal(1, 1, -1) * test::turn(0.5, 0.4, 0.3, -0.7),
      test::diagonal(-1, -1, -1),
  };
  return all;
}

TEST(ShRotation, ARotatedFunctionShowsInRdWhatItShowedInD) {
  std::mt19937 random(7);
  const auto uniform = [&] { return static_cast<double>(random() >> 8) / 8388608.0 - 1; };
  for (const Mat3d& q : turns()) {
    const ShRotation rotation = sh_rotation(q);
    for (int degree = 0; degree <= kMaxShDegree; ++degree)
      for (int repeat = 0; repeat < 20; ++repeat) {
        float before[48], after[48];
        for (int i = 0; i < 48; ++i) before[i] = after[i] = static_cast<float>(uniform() / 6);
        rotate_sh(rotation, degree, after);
        const Vec3d any{uniform(), uniform(), uniform()};
        const Vec3d d = (1 / std::sqrt(dot(any, any))) * any;
        const auto colour = [&](const float* sh, const Vec3d& direction) {
          return sh_colour(degree, direction, [sh](int k, int channel) {
            return static_cast<double>(sh[3 * k + channel]);
          });
        };
        const Vec3d expected = colour(before, d), found = colour(after, q * d);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-5) << degree;
      }
  }
}

// Axis conversions change signs only, to the bit.
TEST(ShRotation, HalfTurnsKeepTheNumbers) {
  const ShRotation rotation = sh_rotation(test::diagonal(-1, -1, 1));
  float sh[48], turned[48];
  for (int i = 0; i < 48; ++i) sh[i] = turned[i] = 0.01f * static_cast<float>(i + 1);
  rotate_sh(rotation, 3, turned);
  for (int i = 0; i < 48; ++i) EXPECT_EQ(std::fabs(turned[i]), sh[i]) << i;
}

}  // namespace
}  // namespace voyager::sh_rotation_test
