// The 24 ways to name the same Gaussian: they must all be rotations, leave the
// covariance alone, and bring a child as near its parent as any of them can.
#include "runtime/math/axes.h"

#include "tests/support/test_support.h"

namespace voyager::axes_test {
namespace {

Quatd random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return normalise(Quatd{normal(random), normal(random), normal(random), normal(random)});
}

double nearness(const Quatd& a, const Quatd& b) {
  return std::fabs(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z);
}

TEST(Axes, CubeRotationIsTheMatrixThatTheCodeDescribes) {
  for (int code = 0; code < kAxisCodes; ++code) {
    const AxisCode a = axis_code(code);
    const Mat3d m = rotation(cube_rotation<double>(code));
    double determinant = 0.0;
    for (int i = 0; i < 3; ++i) {
      for (int row = 0; row < 3; ++row)
        EXPECT_NEAR(m.row[row][i], row == a.from[i] ? a.sign[i] : 0, 1e-15) << "code " << code;
      determinant += m.row[0][i] * (m.row[1][(i + 1) % 3] * m.row[2][(i + 2) % 3] -
                                    m.row[1][(i + 2) % 3] * m.row[2][(i + 1) % 3]);
    }
    EXPECT_NEAR(determinant, 1.0, 1e-15) << "code " << code;
  }
}

TEST(Axes, CodesAreDistinctAndZeroIsTheIdentity) {
  for (int a = 0; a < kAxisCodes; ++a)
    for (int b = 0; b < a; ++b)
      EXPECT_LT(nearness(cube_rotation<double>(a), cube_rotation<double>(b)), 0.75)
          << a << " " << b;
  EXPECT_EQ(nearness(cube_rotation<double>(0), {1, 0, 0, 0}), 1.0);
  const Vec3d s = turn_scale(Vec3d{1, 2, 3}, 0);
  EXPECT_TRUE(s.x == 1 && s.y == 2 && s.z == 3);
}

TEST(Axes, NoCodeChangesTheCovariance) {
  std::mt19937 random(1);
  const Vec3d s{0.1, 2.0, 30.0};
  const Quatd q = random_rotation(random);
  const Mat3d r = rotation(q);
  for (int code = 0; code < kAxisCodes; ++code) {
    const Vec3d ts = turn_scale(s, code);
    const Mat3d tr = rotation(q * cube_rotation<double>(code));
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        double before = 0.0, after = 0.0;
        for (int k = 0; k < 3; ++k) {
          before += r.row[i][k] * s[k] * s[k] * r.row[j][k];
          after += tr.row[i][k] * ts[k] * ts[k] * tr.row[j][k];
        }
        EXPECT_NEAR(before, after, 1e-11) << "code " << code;
      }
    }
  }
}

TEST(Axes, NearestCodeIsNearestOfAll) {
  std::mt19937 random(2);
  for (int repeat = 0; repeat < 2000; ++repeat) {
    const Quatd parent = random_rotation(random), child = random_rotation(random);
    const int code = nearest_axis_code(parent, child);
    double best = 0.0;
    for (int other = 0; other < kAxisCodes; ++other)
      best = std::max(best, nearness(parent, child * cube_rotation<double>(other)));
    EXPECT_NEAR(nearness(parent, child * cube_rotation<double>(code)), best, 1e-12);
    EXPECT_GE(best, 0.85);  // the 24 leave no rotation farther than 62.8 degrees: cos 31.4 = 0.854
  }
}

TEST(Axes, TurnsUndoEachOther) {
  std::mt19937 random(3);
  for (int code = 0; code < kAxisCodes; ++code) {
    const Quatd parent = random_rotation(random);
    const Quatd child = parent * cube_rotation<double>(code);
    const Quatd turned = child * cube_rotation<double>(nearest_axis_code(parent, child));
    EXPECT_NEAR(nearness(parent, turned), 1.0, 1e-14) << "code " << code;
  }
}

TEST(Axes, LowestCodeWinsATie) {
  // Halfway between codes 0 and 12 (a quarter turn about x): an eighth of a turn.
  const double half = std::acos(-1.0) / 8;
  const Quatd eighth{std::cos(half), -std::sin(half), 0, 0};
  EXPECT_EQ(nearest_axis_code({1, 0, 0, 0}, eighth), 0);
}

}  // namespace
}  // namespace voyager::axes_test
