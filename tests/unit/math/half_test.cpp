// binary16 both ways: every half, and every point where rounding turns over.
#include "runtime/math/half.h"

#include <gtest/gtest.h>

#include <limits>

namespace voyager::half_test {
namespace {

constexpr uint32_t kInfinity = 0x7c00;

// A finite half's magnitude, from IEEE's definition of its fields.
double value_of(uint32_t half) {
  const int exponent = static_cast<int>(half >> 10), fraction = static_cast<int>(half & 1023);
  return exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
}

uint16_t with_sign(uint32_t half) {
  return static_cast<uint16_t>(half | 0x8000);
}

TEST(Half, EveryFiniteHalfHasItsValueAndSurvives) {
  for (uint32_t h = 0; h < kInfinity; ++h) {
    const float value = half_to_float(static_cast<uint16_t>(h));
    ASSERT_EQ(double{value}, value_of(h)) << h;
    const float negative = half_to_float(with_sign(h));
    ASSERT_EQ(negative, -value) << h;
    ASSERT_TRUE(std::signbit(negative)) << h;
    ASSERT_EQ(float_to_half(value), h);
    ASSERT_EQ(float_to_half(negative), with_sign(h));
  }
}

TEST(Half, RoundsToTheNearestAndTiesToEven) {
  for (uint32_t h = 0; h + 1 < kInfinity; ++h) {
    const auto middle = static_cast<float>((value_of(h) + value_of(h + 1)) / 2);
    const uint32_t even = h % 2 == 0 ? h : h + 1;
    ASSERT_EQ(float_to_half(std::nextafter(middle, 0.0f)), h);
    ASSERT_EQ(float_to_half(middle), even);
    ASSERT_EQ(float_to_half(std::nextafter(middle, 1e9f)), h + 1);
    ASSERT_EQ(float_to_half(std::nextafter(-middle, 0.0f)), with_sign(h));
    ASSERT_EQ(float_to_half(-middle), with_sign(even));
    ASSERT_EQ(float_to_half(std::nextafter(-middle, -1e9f)), with_sign(h + 1));
  }
}

TEST(Half, NothingBecomesInfiniteOrNan) {
  const uint32_t largest = kInfinity - 1;
  for (const float beyond :
       {kMaxHalf, 65519.996f, 65520.0f, 1e30f, std::numeric_limits<float>::max(),
        std::numeric_limits<float>::infinity()}) {
    EXPECT_EQ(float_to_half(beyond), largest) << beyond;
    EXPECT_EQ(float_to_half(-beyond), with_sign(largest)) << beyond;
  }
  EXPECT_EQ(float_to_half(NAN) & 0x7fff, static_cast<int>(largest));
  EXPECT_EQ(float_to_half(std::numeric_limits<float>::denorm_min()), 0);
}

TEST(Half, InfinitiesAndNansOfAFileAreReadAsSuch) {
  for (uint32_t h = kInfinity; h < 0x8000; ++h) {
    const float value = half_to_float(static_cast<uint16_t>(h));
    ASSERT_EQ(std::isinf(value), h == kInfinity) << h;
    ASSERT_EQ(std::isnan(value), h != kInfinity) << h;
    ASSERT_TRUE(std::signbit(half_to_float(with_sign(h)))) << h;
  }
}

}  // namespace
}  // namespace voyager::half_test
