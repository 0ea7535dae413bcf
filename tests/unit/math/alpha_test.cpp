// The binary32 exponentials against double, and that siblings add up.
#include "runtime/math/alpha.h"

#include <limits>

#include "tests/support/test_support.h"

namespace voyager::alpha_test {
namespace {

double ulp(double value) {
  int exponent = 0;
  std::frexp(value, &exponent);
  return std::ldexp(1.0, std::max(exponent, -125) - 24);
}

// The largest error in units of the last place of the exact value.
template <class Approximation, class Exact>
double worst_ulp(double from, double to, size_t steps, const Approximation& f, const Exact& exact) {
  double worst = 0;
  for (size_t i = 0; i <= steps; ++i) {
    const auto x = static_cast<float>(from + (to - from) * static_cast<double>(i) /
                                                 static_cast<double>(steps));
    const double truth = exact(static_cast<double>(x));
    if (truth == 0) {
      EXPECT_EQ(f(x), 0.0f);
      continue;
    }
    worst = std::max(worst, std::fabs(static_cast<double>(f(x)) - truth) / ulp(truth));
  }
  return worst;
}

constexpr size_t kSteps = 1000000;

TEST(Alpha, ExponentialsKeepTheirBounds) {
  const double exact =
      worst_ulp(-87, 0, kSteps, exp_negative, [](double x) { return std::exp(x); });
  const double near = worst_ulp(-6, 0, kSteps, exp_negative, [](double x) { return std::exp(x); });
  const double two =
      worst_ulp(-125, 0, kSteps, exp2_negative, [](double x) { return std::exp2(x); });
  EXPECT_LE(std::max(exact, near), 2.0);
  EXPECT_LE(two, 2.0);
  RecordProperty("exp_ulp", std::to_string(std::max(exact, near)));
  RecordProperty("exp2_ulp", std::to_string(two));
}

TEST(Alpha, Expm1AndLog1mKeepRelativePrecision) {
  const auto expm1 = [](double x) { return std::expm1(x); };
  const auto log1p = [](double a) { return std::log1p(-a); };
  double e = worst_ulp(-87, 0, kSteps, expm1_negative, expm1);
  double l = worst_ulp(0, static_cast<double>(kAlphaMax), kSteps, log1m, log1p);
  for (double scale = 1; scale > 1e-30; scale *= 0.1) {
    e = std::max(e, worst_ulp(-scale, 0, 10000, expm1_negative, expm1));
    l = std::max(l, worst_ulp(0, 0.5 * scale, 10000, log1m, log1p));
  }
  EXPECT_LE(e, 3.0);
  EXPECT_LE(l, 3.0);
  RecordProperty("expm1_ulp", std::to_string(e));
  RecordProperty("log1m_ulp", std::to_string(l));
}

TEST(Alpha, BelowTheirRangeExponentialsStayFiniteAndMonotone) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float x : {-87.0f, -88.0f, -1e10f, -kInfinity}) {
    EXPECT_EQ(exp_negative(x), exp_negative(-87.0f));
    EXPECT_EQ(expm1_negative(x), -1.0f);
  }
  EXPECT_GT(exp_negative(-87.0f), 0.0f);
  EXPECT_EQ(exp2_negative(-kInfinity), exp2_negative(-125.0f));
  EXPECT_EQ(exp_negative(0.0f), 1.0f);
  EXPECT_EQ(exp2_negative(0.0f), 1.0f);
}

constexpr double kSiblings[] = {1, 2, 3, 4, 8, 17, 100, 1e3, 1e4, 1e5, 1e6};

TEST(Alpha, SiblingAlphaKeepsItsDigits) {
  double worst = 0;
  for (const double k : kSiblings)
    for (int ti = 0; ti <= 64; ++ti)
      for (int ai = 0; ai <= 256; ++ai) {
        const float t = static_cast<float>(ti) / 64.0f;
        const float alpha =
            kAlphaThreshold + (kAlphaMax - kAlphaThreshold) * static_cast<float>(ai) / 256.0f;
        const float inverse_k = 1.0f / static_cast<float>(k);
        const double truth = sibling_alpha(double{alpha}, double{t}, 1.0 / k);
        worst =
            std::max(worst, std::fabs(double{sibling_alpha(alpha, t, inverse_k)} - truth) / truth);
      }
  EXPECT_LE(worst, 5e-7);  // 8 half-ulps: log1m, 1/k, the product, expm1, the sum
  RecordProperty("relative_error", std::to_string(worst * 1e9) + "e-9");
}

TEST(Alpha, SiblingsAtTheirParentsPlaceAddUpToIt) {
  double worst = 0;
  for (const double k : kSiblings)
    for (int ai = 0; ai <= 512; ++ai) {
      const float alpha =
          kAlphaThreshold + (kAlphaMax - kAlphaThreshold) * static_cast<float>(ai) / 512.0f;
      const double each =
          static_cast<double>(sibling_alpha(alpha, 0.0f, 1.0f / static_cast<float>(k)));
      const double together = -std::expm1(k * std::log1p(-each));
      worst = std::max(worst, std::fabs(together - double{alpha}));
    }
  EXPECT_LE(worst, 3e-7);
  RecordProperty("absolute_error", std::to_string(worst * 1e9) + "e-9");
}

TEST(Alpha, AnOnlyChildAndTheNodeItselfAreUnchanged) {
  for (int i = 1; i <= 1000; ++i) {
    const float alpha = kAlphaMax * static_cast<float>(i) / 1000.0f;
    EXPECT_EQ(sibling_alpha(alpha, 1.0f, 0.25f), alpha);
    EXPECT_NEAR(sibling_alpha(alpha, 0.0f, 1.0f), alpha, 2e-7f);
  }
}

TEST(Alpha, RhoMinIsTheThresholdOnAlpha) {
  for (const double o : {1.0 / 255, 0.004, 0.1, 0.5, 1.0, 7.0, 1e6})
    for (int i = 0; i <= 4000; ++i) {
      const double rho = -20.0 * i / 4000, alpha = o * std::exp(rho);
      if (std::fabs(alpha * 255 - 1) < 1e-6) continue;  // the constants are binary32
      EXPECT_EQ(rho >= rho_min(std::log(o)), alpha * 255 >= 1) << o << " " << rho;
      EXPECT_EQ(static_cast<float>(rho) >= rho_min(std::log(static_cast<float>(o))),
                alpha * 255 >= 1)
          << o << " " << rho;
    }
  EXPECT_GT(rho_min(-std::numeric_limits<float>::infinity()), 0.0f);
}

}  // namespace
}  // namespace voyager::alpha_test
