// METHOD §6: what the binary32 depth can tell apart, from a centimetre to a hundred kilometres.
// What it is, to the bit, is unit/sort_key's to say.
#include <cmath>
#include <random>

#include "runtime/frame/depth_order.h"
#include "runtime/math/sort_key.h"
#include "tests/numerics/measured.h"

namespace voyager::depth_order_test {
namespace {

using test::kEpsilon;

constexpr double kNearest = 1e-2, kFarthest = 1e5;

struct Sample {
  Vec3d axis, offset;  // the view axis and d, as they are
};

// z along the axis, and `slope` times that across it.
Sample sample(std::mt19937& random, double z, double slope) {
  std::normal_distribution<double> normal;
  const auto unit = [](const Vec3d& v) { return (1 / std::sqrt(dot(v, v))) * v; };
  const double a = normal(random), b = normal(random), c = normal(random);
  const double d = normal(random), e = normal(random), f = normal(random);
  const Vec3d axis = unit({a, b, c}), any{d, e, f};
  const Vec3d across = unit(any - dot(any, axis) * axis);
  return {axis, z * axis + z * slope * across};
}

float key_of(const Sample& s) {
  const Vec3f axis{static_cast<float>(s.axis.x), static_cast<float>(s.axis.y),
                   static_cast<float>(s.axis.z)};
  return view_depth(camera_relative({0, 0, 0}, s.offset, {0, 0, 0}), axis);
}

double distance(const Sample& s) {
  return std::sqrt(dot(s.offset, s.offset));
}

// d and the axis are rounded, then each product and two sums: 5ε·Σ|d_k·f_k| ≤ 5ε·|d|.
TEST(DepthOrder, DepthIsWithinFiveEpsilonOfTheDistance) {
  std::mt19937 random(1);
  for (const double slope : {0.0, 0.6, 2.0, 11.0}) {  // to the corner of 170 degrees
    double worst = 0;
    for (double z = kNearest; z <= kFarthest; z *= 1.001) {
      const Sample s = sample(random, z, slope);
      worst = std::max(worst, std::fabs(double{key_of(s)} - dot(s.offset, s.axis)) / distance(s));
    }
    EXPECT_LE(worst, 5 * kEpsilon) << slope;
    test::record("slope_" + std::to_string(slope).substr(0, 4) + "_units", worst / kEpsilon);
  }
}

// Two splats a layer apart, wherever they are in the image, are in order from some distance
// between the layers on; the walls of a façade are not, and go by their ids.
TEST(DepthOrder, LayersAreInOrderFromTenEpsilonApart) {
  std::mt19937 random(2);
  size_t disorder = 0;
  for (const double slope : {0.0, 0.6, 2.0}) {
    const double stretch = std::sqrt(1 + slope * slope);
    for (double z = kNearest; z <= kFarthest; z *= 1.001) {
      const Sample nearer = sample(random, z, slope);
      const auto beyond = [&](double gap) {
        return Sample{nearer.axis, nearer.offset + gap * z * nearer.axis};
      };
      ASSERT_LT(key_of(nearer), key_of(beyond(10 * kEpsilon * stretch))) << z;
      disorder += key_of(nearer) >= key_of(beyond(0.25 * kEpsilon));
    }
  }
  EXPECT_GT(disorder, 1000u);  // or ten would be far too much
}

// The keys lose nothing of the depth: as many as there are binary32 numbers between the ends.
TEST(DepthOrder, NeighbouringDepthsHaveKeysInTheirOrder) {
  const auto far = static_cast<float>(kFarthest);
  for (auto z = static_cast<float>(kNearest); z < far; z *= 1.0001f) {
    const float next = std::nextafter(z, far);
    ASSERT_LT(depth_key(z, UINT32_MAX), depth_key(next, 0)) << z;
    ASSERT_LT(depth_key(z, 0), depth_key(z, 1)) << z;
    ASSERT_EQ(depth_key_index(depth_key(z, UINT32_MAX)), UINT32_MAX);
  }
}

}  // namespace
}  // namespace voyager::depth_order_test
