// The table that can replace the exponential: its ends, its index, its error.
#include "runtime/math/alpha_lut.h"

#include <limits>
#include <vector>

#include "runtime/math/alpha.h"
#include "tests/support/test_support.h"

namespace voyager::alpha_lut_test {
namespace {

std::vector<float> table(uint32_t m) {
  std::vector<float> entries(m + 1);
  fill_alpha_lut(m, entries.data());
  return entries;
}

TEST(AlphaLut, ReachesBothEndsAndNeverBeyond) {
  for (uint32_t m = 1; m <= kMaxLutSize; m = m < 64 ? m + 1 : m * 2) {
    const std::vector<float> lut = table(m);
    const float scale = static_cast<float>(m) / kLutRange;
    const auto last = static_cast<int32_t>(m);
    EXPECT_EQ(lut.front(), 1.0f);
    EXPECT_NEAR(lut.back(), std::exp(-5.55), 1e-9);
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const float x : {0.0f, 1.0f, 1e30f, kInfinity}) EXPECT_EQ(alpha_lut_index(x, scale), 0);
    for (const float x : {-kLutRange, -6.0f, -1e30f, -kInfinity})
      EXPECT_EQ(alpha_lut_index(x, scale), last);
    int32_t before = 0;
    for (int i = 0; i <= 10000; ++i) {
      const int32_t index = alpha_lut_index(-kLutRange * static_cast<float>(i) / 10000.0f, scale);
      ASSERT_GE(index, before);
      ASSERT_LE(index, last);
      before = index;
    }
  }
}

TEST(AlphaLut, TakesTheNearestEntry) {
  const uint32_t m = 32;
  const float scale = m / kLutRange;
  for (int i = 0; i <= 100000; ++i) {
    const float x = -kLutRange * static_cast<float>(i) / 100000.0f;
    const double place = -double{x} / double{kLutRange} * m;
    EXPECT_LE(std::fabs(place - alpha_lut_index(x, scale)), 0.5 + 1e-5);
  }
}

TEST(AlphaLut, HasTheErrorThatIsStatedForIt) {
  const std::vector<float> lut = table(32);
  double worst = 0, squares = 0;
  constexpr int kSamples = 1000000;
  for (int i = 0; i <= kSamples; ++i) {
    const float x = kLogAlphaThreshold * static_cast<float>(i) / static_cast<float>(kSamples);
    const double value =
        static_cast<double>(lut[static_cast<size_t>(alpha_lut_index(x, 32 / kLutRange))]);
    const double error = value / std::exp(double{x}) - 1;
    worst = std::max(worst, std::fabs(error));
    squares += error * error;
  }
  EXPECT_NEAR(worst, 0.0906, 0.0002);
  EXPECT_NEAR(std::sqrt(squares / kSamples), 0.050, 0.001);
}

}  // namespace
}  // namespace voyager::alpha_lut_test
