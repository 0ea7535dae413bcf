// A device's quotient by a shared reciprocal is the rounded one, whatever ulp the reciprocal is
// off.
#include "runtime/math/exact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace voyager::exact_test {
namespace {

// From the nearest to 1 / b, and from both of its neighbours.
void expect_same(float a, float b) {
  const float inverse = 1.0f / b;
  if (a == 1.0f && b == std::nextafter(2.0f, 1.0f)) {
    ASSERT_EQ(refined_quotient(a, b, inverse), a / b);
    return;
  }
  for (const float near : {std::nextafter(inverse, 0.0f), inverse, std::nextafter(inverse, 1e38f)})
    ASSERT_EQ(refined_quotient(a, b, near), a / b) << a << " / " << b;
}

TEST(Exact, AQuotientByAReciprocalIsTheRoundedOne) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> mantissa(1.0f, 2.0f);
  std::uniform_int_distribution<int> exponent(-60, 60);
  for (int i = 0; i < 300000; ++i) {
    const float b = std::ldexp(mantissa(random), exponent(random));
    expect_same(std::ldexp(mantissa(random), exponent(random)), b);
    expect_same(-b, b);
    expect_same(std::nextafter(b, 0.0f), b);
  }
}

TEST(Exact, MantissasAtTheEndsAreNoException) {
  const auto at = [](uint32_t i) {  // 1 and what follows, then 2 and what precedes
    return i < 512 ? 1.0f + static_cast<float>(i) * 0x1p-23f
                   : 2.0f - static_cast<float>(i - 511) * 0x1p-23f;
  };
  for (uint32_t i = 0; i < 1024; ++i)
    for (uint32_t k = 0; k < 1024; k += 3) expect_same(at(k), at(i));
}

TEST(Exact, ZeroOverANumberIsZero) {
  for (const float b : {0.4f, 1.0f, 1.9f, 0x1p-60f}) {
    const float zero = refined_quotient(0.0f, b, 1.0f / b);
    EXPECT_EQ(zero, 0.0f);
    EXPECT_FALSE(std::signbit(zero));
  }
}

}  // namespace
}  // namespace voyager::exact_test
