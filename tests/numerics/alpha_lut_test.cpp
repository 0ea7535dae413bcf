// METHOD §8: the table's error against its size, over its range and at both ends of it.
#include "runtime/math/alpha_lut.h"

#include <algorithm>
#include <vector>

#include "runtime/math/alpha.h"
#include "tests/numerics/measured.h"

namespace voyager::alpha_lut_test {
namespace {

struct LutErrors {
  double relative = 0, rms = 0, bias = 0;  // of α where it counts: α* to 1
  double top = 0, bottom = 0;              // the largest of α itself within an interval of an end
};

constexpr int kSamples = 200000;

LutErrors measure(uint32_t m) {
  std::vector<float> entries(m + 1);
  fill_alpha_lut(m, entries.data());
  const float scale = static_cast<float>(m) / kLutRange;
  const double interval = double{kLutRange} / m, threshold = double{kLogAlphaThreshold};
  LutErrors e;
  for (int i = 0; i <= kSamples; ++i) {
    const auto x = static_cast<float>(threshold * i / kSamples);
    const double value = double{entries[static_cast<size_t>(alpha_lut_index(x, scale))]};
    const double error = value - std::exp(double{x}), share = error / std::exp(double{x});
    e.relative = std::max(e.relative, std::fabs(share));
    e.rms += share * share / kSamples, e.bias += share / kSamples;
    if (double{x} >= -interval) e.top = std::max(e.top, std::fabs(error));
    if (double{x} <= threshold + interval) e.bottom = std::max(e.bottom, std::fabs(error));
  }
  e.rms = std::sqrt(e.rms);
  return e;
}

// Half an interval h off, e^x is off by a factor of e^(h/2): that is the largest relative error
// anywhere. Its mean square is that of a uniform distance, h/√12, its mean h²/24. The largest of α
// is at the top, 1 - e^(-h/2) just below x = 0; at the bottom it is 1/255 of the relative one, and
// α may come out below α*, by e^(-h/2) at most.
TEST(AlphaLutSize, ErrorsAreThoseOfHalfAnInterval) {
  for (const uint32_t m : {8u, 16u, 31u, 32u, 64u, 128u}) {
    const LutErrors e = measure(m);
    const double half = 0.5 * double{kLutRange} / m;
    EXPECT_LE(e.relative, std::expm1(half) * 1.001) << m;
    EXPECT_GE(e.relative, std::expm1(half) * 0.98) << m;
    EXPECT_NEAR(e.rms, half / std::sqrt(3.0), 0.06 * half) << m;
    EXPECT_NEAR(e.bias, half * half / 6, 0.1 * half * half / 6) << m;
    EXPECT_LE(e.top, -std::expm1(-half) * 1.001) << m;
    EXPECT_GE(e.top, -std::expm1(-half) * 0.98) << m;
    EXPECT_LE(e.bottom, 1.02 * std::exp(2 * half) * std::expm1(half) / 255) << m;
    const std::string name = "m_" + std::to_string(m);
    test::record(name + "_relative", e.relative);
    test::record(name + "_rms", e.rms);
    test::record(name + "_bias", e.bias);
    test::record(name + "_top", e.top);
    test::record(name + "_bottom", e.bottom);
  }
}

}  // namespace
}  // namespace voyager::alpha_lut_test
