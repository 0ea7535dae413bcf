// METHOD §4 where t goes to 0 and to 1: the weight, and what lies between a node and its parent.
#include "runtime/math/lerp.h"

#include <algorithm>
#include <random>

#include "runtime/lod/tree_rule.h"
#include "runtime/math/axes.h"
#include "tests/numerics/footprints.h"
#include "tests/numerics/measured.h"

namespace voyager::weights_test {
namespace {

using test::kEpsilon;

float step(float x, int times) {
  for (; times > 0; --times) x = std::nextafter(x, INFINITY);
  for (; times < 0; ++times) x = std::nextafter(x, 0.0f);
  return x;
}

// The sizes are binary32 by contract. The target lies within a factor of two of start and of
// the parent's size: both differences are exact. One quotient and one difference from 1 are
// rounded, by ε/2 each; and start itself, by ε/2 of it, where the share is not a power of two.
void check_weights(float share, double bound, const char* record) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  double worst = 0;
  size_t near_zero = 0, near_one = 0;
  for (int i = 0; i < 20000; ++i) {
    const float parent = std::ldexp(1 + uniform(random), static_cast<int>(random() % 60) - 40);
    const float size = random() % 4 == 0 ? 0 : parent * std::sqrt(uniform(random));
    const float start = std::max(share * parent, size);
    for (int k = 0; k < 24; ++k) {
      const int ulps = static_cast<int>(random() % 16);
      const float target = k < 8    ? step(start, ulps)
                           : k < 16 ? step(parent, -ulps)
                                    : start + (parent - start) * uniform(random);
      if (target < start || target > parent) continue;
      const double found = double{interpolation_weight(true, parent, size, target, share)};
      const double t =
          interpolation_weight(true, double{parent}, double{size}, double{target}, double{share});
      worst = std::max(worst, std::fabs(found - t));
      near_zero += t > 0 && t < 1e-5, near_one += t < 1 && t > 1 - 1e-5;
      ASSERT_TRUE(found >= 0 && found <= 1);
    }
  }
  EXPECT_LE(worst, bound * kEpsilon);
  EXPECT_GT(near_zero, 1000u);
  EXPECT_GT(near_one, 1000u);
  test::record(record, worst / kEpsilon);
}

TEST(WeightEnds, TheWeightOfGivenSizesIsWithinAnEpsilon) {
  check_weights(kHalfShare, 1, "weight_units");
}
TEST(WeightEnds, WhereBlendingStartsLateWithinFifty) {
  check_weights(kLateShare, 50, "late_weight_units");
}

// Their own, however thin an axis is under its parent's: both terms are positive, so nothing
// cancels as t goes to 1. The textbook's parent + t (node − parent) keeps the parent's digits only.
TEST(WeightEnds, ScalesAndOpacitiesKeepTheirDigits) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (const float ratio : {1e-8f, 1e-4f, 1.0f, 1e4f, 1e8f}) {
    double relative = 0, textbook = 0;
    for (int i = 0; i < 20000; ++i) {
      const float parent = 0.5f + uniform(random), node = parent * ratio * (0.5f + uniform(random));
      const float t = i % 3 == 0   ? step(1, -1 - static_cast<int>(random() % 8))
                      : i % 3 == 1 ? std::ldexp(1.0f, -1 - static_cast<int>(random() % 24))
                                   : uniform(random);
      const float found = lerp_positive(parent, node, t);
      const double exact = lerp_positive(double{parent}, double{node}, double{t});
      ASSERT_GT(found, 0.0f);
      relative = std::max(relative, std::fabs(double{found} / exact - 1));
      textbook = std::max(textbook, std::fabs(double{lerp(parent, node, t)} / exact - 1));
    }
    EXPECT_LE(relative, 3 * kEpsilon) << ratio;
    const std::string name = "scale_ratio_" + std::to_string(std::lround(std::log10(ratio)));
    test::record(name + "_in_epsilon", relative / kEpsilon);
    test::record(name + "_textbook", textbook);
  }
}

// The sign that a quaternion is taken with is never decided by rounding: once its axes are
// turned to the parent's, a rotation is within half of 62.8 degrees of it, as quaternions go.
TEST(WeightEnds, AlignedRotationsAreFarFromTheTurnOfSign) {
  std::mt19937 random(3);
  double least = 1;
  for (int i = 0; i < 100000; ++i) {
    const Quatf a = test::random_turn(random), b = test::random_turn(random);
    const Quatd parent{a.w, a.x, a.y, a.z}, child{b.w, b.x, b.y, b.z};
    const Quatd q = child * cube_rotation<double>(nearest_axis_code(parent, child));
    least = std::min(least,
                     std::fabs(parent.w * q.w + parent.x * q.x + parent.y * q.y + parent.z * q.z));
  }
  EXPECT_GE(least, 0.853);
  test::record("least_dot", least);
}

}  // namespace
}  // namespace voyager::weights_test
