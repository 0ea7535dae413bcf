// Host depth values to metres: each convention against its projection in double.
#include "runtime/math/host_depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace voyager::host_depth_test {
namespace {

constexpr double kEpsilon = 0x1p-24;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Projection {
  DepthForm form;
  double near, far;

  bool reversed() const { return form == DepthForm::reversed; }
  float near_value() const { return reversed() ? 1.0f : 0.0f; }
  float far_value() const { return reversed() ? 0.0f : 1.0f; }
  // As hosts write it: d = a + b / z.
  double value(double z) const {
    const double a = 1 / (1 - near / far), b = -near * a;
    return reversed() ? (1 - a) - b / z : a + b / z;
  }
  double metres(double d) const {
    const double t = reversed() ? d : 1 - d;
    return 1 / (1 / far + (1 / near - 1 / far) * t);
  }
  DepthEncoding encoding() const { return depth_encoding(form, near, far); }
};

std::vector<Projection> projections() {
  std::vector<Projection> all;
  for (const DepthForm form : {DepthForm::standard, DepthForm::reversed})
    for (const auto& [near, far] : {std::pair(0.1, 1000.0),
                                    {0.05, double{INFINITY}},
                                    {1.0, 2.0},
                                    {0.01, 1e6},
                                    {10.0, 10.001},
                                    {1e-18, 1e18},
                                    {1e-18, double{INFINITY}},
                                    {1e18, 1e300},
                                    {0.2, 1e308}})
      all.push_back({form, near, far});
  return all;
}

TEST(HostDepth, ComesBackAsFarAsItsBitsReach) {
  for (const Projection& p : projections()) {
    const DepthEncoding encoding = p.encoding();
    const double most = std::fmin(p.far, 1e6 * p.near);
    for (int i = 0; i <= 1000; ++i) {
      const double z = p.near * std::pow(most / p.near, i / 1000.0);
      const auto d = static_cast<float>(p.value(z));
      const float found = depth_limit(encoding, d);
      if (d == p.far_value()) {
        EXPECT_EQ(found, kInfinity) << z;
        continue;
      }
      const double exact = p.metres(d);
      ASSERT_NEAR(found, exact, 5 * kEpsilon * exact) << p.near << " " << p.far << " " << z;
      // What rounding d to binary32 can have moved z by, and what it took to find d in double.
      const double slope = (1 / p.near - 1 / p.far) * exact * exact;
      const double place = kEpsilon * std::fmax(double{d}, 0x1p-126) + 4e-16;
      ASSERT_NEAR(found, z, 5 * kEpsilon * exact + 1.01 * slope * place + 1e-12 * exact)
          << p.near << " " << p.far << " " << z;
    }
  }
}

TEST(HostDepth, NearerIsNeverFarther) {
  for (const Projection& p : projections()) {
    const DepthEncoding encoding = p.encoding();
    float last = 0;
    for (int i = 0; i <= 100000; ++i) {
      const float share = static_cast<float>(i) / 100000;
      const float z = depth_limit(encoding, p.reversed() ? 1 - share : share);
      ASSERT_GE(z, last) << share;
      last = z;
    }
    EXPECT_EQ(last, kInfinity);
  }
}

TEST(HostDepth, TheFarValueAndNanAreNoGeometry) {
  for (const Projection& p : projections()) {
    EXPECT_EQ(depth_limit(p.encoding(), p.far_value()), kInfinity);
    EXPECT_EQ(depth_limit(p.encoding(), kNan), kInfinity);
    const float next = std::nextafter(p.far_value(), p.near_value());
    if (p.far < 1e30) {
      EXPECT_LT(depth_limit(p.encoding(), next), kInfinity);
    }
  }
  EXPECT_EQ(depth_limit(Projection{DepthForm::reversed, 1, 2}.encoding(), -0.0f), kInfinity);
}

TEST(HostDepth, IsClampedToTheProjectionsRange) {
  for (const Projection& p : projections()) {
    const float nearest = depth_limit(p.encoding(), p.near_value());
    EXPECT_NEAR(nearest, p.near, 5 * kEpsilon * p.near);
    const float outward = p.reversed() ? 1.0f : -1.0f;  // from near
    for (const float beyond : {1e-7f, 0.5f, 1e30f, kInfinity}) {
      EXPECT_EQ(depth_limit(p.encoding(), p.near_value() + outward * beyond), nearest);
      EXPECT_EQ(depth_limit(p.encoding(), p.far_value() - outward * beyond), kInfinity);
    }
  }
}

TEST(HostDepth, MetresAreThemselves) {
  const DepthEncoding metres = depth_encoding(DepthForm::metres, kNan, 0);
  for (const float z : {0.0f, 1e-45f, 0.25f, 1.0f, 3e38f, kInfinity, -1.0f})
    EXPECT_EQ(depth_limit(metres, z), z);
  EXPECT_EQ(depth_limit(metres, kNan), kInfinity);
  EXPECT_EQ(depth_limit({}, 7.5f), 7.5f) << "what DepthLimits begin with";
}

TEST(HostDepth, RowsLieAPitchApart) {
  const float values[] = {1, 2, -1, 3, 4, -1};
  const DepthLimits limits{values, 3 * sizeof(float), {}};
  EXPECT_EQ(limits.at(0, 0), 1);
  EXPECT_EQ(limits.at(1, 0), 2);
  EXPECT_EQ(limits.at(0, 1), 3);
  EXPECT_EQ(limits.at(1, 1), 4);
}

}  // namespace
}  // namespace voyager::host_depth_test
