#pragma once
// Hosts change the floating-point mode (flush-to-zero, rounding). The numeric
// contract needs the default one, so every entry point and every parallel body
// holds this guard and puts back what it found.
#include <cfenv>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace voyager {

class FloatingPointMode {
 public:
#if defined(__SSE2__)
  FloatingPointMode() : saved_(_mm_getcsr()) {
    if ((saved_ & ~kStatus) != kDefault) _mm_setcsr(kDefault);
  }
  ~FloatingPointMode() {
    if ((saved_ & ~kStatus) != kDefault) _mm_setcsr(saved_);
  }

 private:
  static constexpr unsigned kStatus = 0x3f;     // sticky exception flags
  static constexpr unsigned kDefault = 0x1f80;  // round to nearest, no FTZ/DAZ, exceptions masked
  unsigned saved_;
#else
  FloatingPointMode() {
    std::fegetenv(&saved_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~FloatingPointMode() {
    std::fesetenv(&saved_);
  }

 private:
  std::fenv_t saved_;
#endif
 public:
  FloatingPointMode(const FloatingPointMode&) = delete;
  FloatingPointMode& operator=(const FloatingPointMode&) = delete;
};

}  // namespace voyager
