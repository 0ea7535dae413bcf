// Whatever mode a host is in, the guard gives the default one and puts back the host's.
#include "runtime/base/floating_point_mode.h"

#include <gtest/gtest.h>

#include <limits>

namespace voyager::floating_point_mode_test {
namespace {

// The control register, without x86's exception flags.
#if defined(__SSE2__)
uint32_t control() {
  return _mm_getcsr() & ~0x3fu;
}
void set_control(uint32_t value) {
  _mm_setcsr(value);
}
constexpr uint32_t kFlushToZero = 0x8040;  // FTZ, DAZ
#elif defined(__aarch64__)
uint64_t control() {
  uint64_t value;
  asm volatile("mrs %0, fpcr" : "=r"(value));
  return value;
}
void set_control(uint64_t value) {
  asm volatile("msr fpcr, %0" : : "r"(value));
}
constexpr uint64_t kFlushToZero = uint64_t{1} << 24;  // FZ
#endif

struct Results {
  float subnormal, third, minus_third;
};

// Computed when it is called, in the mode of that moment.
__attribute__((noinline)) Results compute() {
  volatile float tiny = 1e-22f, one = 1.0f, three = 3.0f;
  volatile Results results{tiny * tiny, one / three, -one / three};
  return {results.subnormal, results.third, results.minus_third};
}

TEST(FloatingPointMode, IsTheDefaultInsideAndTheHostsAfterwards) {
  const auto standard = control();
  const Results expected = compute();
  ASSERT_GT(expected.subnormal, 0.0f);
  ASSERT_EQ(expected.third, -expected.minus_third);
  for (const int rounding : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO})
    for (const bool flush : {false, true}) {
      std::fesetround(rounding);
      if (flush) set_control(control() | kFlushToZero);
      const auto host = control();
      const Results in_host_mode = compute();
      Results inside;
      {
        const FloatingPointMode mode;
        inside = compute();
      }
      const auto after = control();
      set_control(standard);
      EXPECT_EQ(after, host);
      EXPECT_EQ(inside.subnormal, expected.subnormal);
      EXPECT_EQ(inside.third, expected.third);
      EXPECT_EQ(inside.minus_third, expected.minus_third);
      // The host's mode was what it is meant to be.
      EXPECT_EQ(in_host_mode.subnormal == 0.0f, flush);
    }
}

}  // namespace
}  // namespace voyager::floating_point_mode_test
