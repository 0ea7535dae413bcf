// METHOD §3: the predicate at its edges.
#include "runtime/math/screen_size.h"

#include <limits>

#include "tests/support/test_support.h"

namespace voyager::screen_size_test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
const Vec3f kLow{-1, -2, -3}, kHigh{1, 2, 3};

TEST(ScreenSize, IsInfiniteInsideAndOnTheBox) {
  EXPECT_EQ(screen_size({0, 0, 0}, kLow, kHigh, 6), kInfinity);
  EXPECT_EQ(screen_size({1, 0, 0}, kLow, kHigh, 6), kInfinity);
  EXPECT_EQ(screen_size({1, 2, -3}, kLow, kHigh, 6), kInfinity);
  EXPECT_EQ(screen_size({0, 0, 0}, kLow, kHigh, 0), kInfinity);  // a leaf too
}

TEST(ScreenSize, IsExtentOverDistance) {
  EXPECT_EQ(screen_size({1, 2, 7}, kLow, kHigh, 6), 1.5f);
  EXPECT_EQ(screen_size({4, 6, 3}, kLow, kHigh, 6), 1.2f);  // 3, 4, 5
  EXPECT_EQ(screen_size({4, 6, 3}, kLow, kHigh, 0), 0.0f);
  EXPECT_EQ(screen_size({4, 6, 3}, kLow, kHigh, kInfinity), kInfinity);
  // The next float outside the face is far enough to be finite.
  const float next = std::nextafter(1.0f, 2.0f);
  EXPECT_EQ(screen_size({next, 0, 0}, kLow, kHigh, 6), 6.0f / (next - 1.0f));
}

TEST(ScreenSize, NearZeroAndFarAway) {
  // 1e-24 m outside a face at 0: the square is subnormal or 0, never an error.
  EXPECT_EQ(screen_size({-1e-24f, 0, 0}, {0, 0, 0}, kHigh, 1), kInfinity);
  const float tiny = 1e-22f, square = tiny * tiny;  // a subnormal, which flush-to-zero would lose
  EXPECT_GT(square, 0.0f);
  EXPECT_EQ(screen_size({-tiny, 0, 0}, {0, 0, 0}, kHigh, 1), 1.0f / std::sqrt(square));
  const float far = screen_size({1e17f, -1e17f, 1e17f}, kLow, kHigh, 6);
  EXPECT_TRUE(far > 0.0f && far < 1e-15f);
  EXPECT_GT(screen_size({9.9e17f, 9.9e17f, 9.9e17f}, {-9.9e17f, -9.9e17f, -9.9e17f},
                        {-9e17f, -9e17f, -9e17f}, 1e17f),
            0.0f);
}

// Each operation rounded, in METHOD's order: written so that no compiler may fuse it, and on its
// own, because sharing its products with screen_size would keep those from being fused.
__attribute__((noinline)) float stepwise_from_origin(const Vec3f& c, float extent) {
  volatile float x = c.x * c.x, y = c.y * c.y, z = c.z * c.z;
  volatile float sum = x + y;
  volatile float squared = sum + z;
  return extent / std::sqrt(squared);
}

TEST(ScreenSize, RoundsEachOperation) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(-100, 100);
  size_t fused_differs = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec3f c{uniform(random), uniform(random), uniform(random)};
    const float expected = stepwise_from_origin(c, 2);
    ASSERT_EQ(screen_size(c, {0, 0, 0}, {0, 0, 0}, 2), expected);
    fused_differs += 2 / std::sqrt(std::fma(c.z, c.z, std::fma(c.y, c.y, c.x * c.x))) != expected;
  }
  EXPECT_GT(fused_differs, 1000u);  // or the test could not tell
}

TEST(ScreenSize, NeverGrowsFromParentToChild) {
  std::mt19937 random(1);
  const auto uniform = [&](float lo, float hi) {
    return lo + (hi - lo) * (static_cast<float>(random() >> 8) / 16777216.0f);
  };
  for (int i = 0; i < 500000; ++i) {
    const float unit = std::ldexp(1.0f, static_cast<int>(random() % 60) - 20);
    Vec3f low, high, inner_low, inner_high, c;
    float extent = 0, inner_extent = 0;
    for (int k = 0; k < 3; ++k) {
      low[k] = unit * uniform(-1, 1);
      high[k] = low[k] + unit * uniform(0, 1);
      inner_low[k] = random() % 3 == 0
                         ? low[k]
                         : std::min(high[k], low[k] + uniform(0, 1) * (high[k] - low[k]));
      inner_high[k] =
          random() % 3 == 0
              ? high[k]
              : std::min(high[k], inner_low[k] + uniform(0, 1) * (high[k] - inner_low[k]));
      c[k] = random() % 4 == 0
                 ? inner_high[k]
                 : (random() % 4 == 0 ? std::nextafter(high[k], 1e30f) : unit * uniform(-4, 4));
      extent = std::max(extent, high[k] - low[k]);
      inner_extent = std::max(inner_extent, inner_high[k] - inner_low[k]);
    }
    ASSERT_LE(inner_extent, extent);
    ASSERT_LE(screen_size(c, inner_low, inner_high, inner_extent),
              screen_size(c, low, high, extent));
  }
}

TEST(ScreenSize, TargetIsRoundedOnceFromDouble) {
  EXPECT_EQ(target_size(0, 1000), static_cast<float>(1.0 / 1000.0));
  EXPECT_EQ(target_size(3, 1400), static_cast<float>(7.0 / 1400.0));
  EXPECT_EQ(target_size(1e300, 1e-10), kInfinity);
  const Vec3f c = cut_centre({6.4e6 + 1e-3, 1, -2}, {6250.0 * 1024, 0, 0});
  EXPECT_EQ(c.x, static_cast<float>(6.4e6 + 1e-3 - 6250.0 * 1024));
}

}  // namespace
}  // namespace voyager::screen_size_test
