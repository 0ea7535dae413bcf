#pragma once
// Binary32 operations rounded once, to nearest: no compiler may contract them. On
// the host -ffp-contract=off says the same (cmake/compile_options.cmake).
#include <cmath>

#include "runtime/math/host_device.h"

namespace voyager {

VOYAGER_HD float add_rn(float a, float b) {
#if defined(__CUDA_ARCH__)
  return __fadd_rn(a, b);
#else
  return a + b;
#endif
}

VOYAGER_HD float subtract_rn(float a, float b) {
#if defined(__CUDA_ARCH__)
  return __fsub_rn(a, b);
#else
  return a - b;
#endif
}

VOYAGER_HD float multiply_rn(float a, float b) {
#if defined(__CUDA_ARCH__)
  return __fmul_rn(a, b);
#else
  return a * b;
#endif
}

VOYAGER_HD float divide_rn(float a, float b) {
#if defined(__CUDA_ARCH__)
  return __fdiv_rn(a, b);
#else
  return a / b;
#endif
}

VOYAGER_HD float sqrt_rn(float a) {
#if defined(__CUDA_ARCH__)
  return __fsqrt_rn(a);
#else
  return std::sqrt(a);
#endif
}

// A binary32 number whose operations are these, for formulas that must come out the same
// wherever they are compiled.
struct Rounded {
  float value;

  VOYAGER_HD Rounded(float v) : value(v) {}
};
VOYAGER_HD Rounded operator+(Rounded a, Rounded b) {
  return add_rn(a.value, b.value);
}
VOYAGER_HD Rounded operator-(Rounded a, Rounded b) {
  return subtract_rn(a.value, b.value);
}
VOYAGER_HD Rounded operator*(Rounded a, Rounded b) {
  return multiply_rn(a.value, b.value);
}
VOYAGER_HD Rounded operator/(Rounded a, Rounded b) {
  return divide_rn(a.value, b.value);
}
VOYAGER_HD Rounded operator-(Rounded a) {
  return -a.value;
}
VOYAGER_HD bool operator<(Rounded a, Rounded b) {
  return a.value < b.value;
}
VOYAGER_HD bool operator>(Rounded a, Rounded b) {
  return a.value > b.value;
}
VOYAGER_HD Rounded sqrt(Rounded a) {
  return sqrt_rn(a.value);
}

VOYAGER_HD Rounded fabs(Rounded a) {
  return std::fabs(a.value);
}

// a / b rounded as divide_rn() rounds it, from a number within an ulp of 1 / b: step by step what a
// device's division does where nothing overflows or is subnormal on the way. The number has to be
// the nearest where b's mantissa is all ones and a's is 1.
VOYAGER_HD float refined_quotient(float a, float b, float near_inverse) {
  const float inverse = std::fma(near_inverse, std::fma(-b, near_inverse, 1.0f), near_inverse);
  const float near_quotient = a * inverse;
  return std::fma(std::fma(-b, near_quotient, a), inverse, near_quotient);
}

// What several numbers are divided by. On a device they share a reciprocal, and no quotient has a
// slow path, so that it is divide_rn()'s only where the divisor and the quotient are from 2⁻¹⁰⁰ to
// 2¹⁰⁰, or the quotient is +0. A smaller one is near it, a larger one may be NaN.
class Divisor {
 public:
  VOYAGER_HD explicit Divisor(Rounded divisor) : divisor_(divisor.value) {
#if defined(__CUDA_ARCH__)
    asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(near_inverse_) : "f"(divisor_));
#endif
  }
  VOYAGER_HD Rounded quotient(Rounded a) const {
#if defined(__CUDA_ARCH__)
    return refined_quotient(a.value, divisor_, near_inverse_);
#else
    return a.value / divisor_;
#endif
  }

 private:
  float divisor_;
#if defined(__CUDA_ARCH__)
  float near_inverse_;
#endif
};

// Within 2⁻²³ of the root, relatively; on a device cheaper than the rounded one.
VOYAGER_HD float sqrt_near(float a) {
#if defined(__CUDA_ARCH__)
  float root;
  asm("sqrt.approx.f32 %0, %1;" : "=f"(root) : "f"(a));
  return root;
#else
  return std::sqrt(a);
#endif
}

}  // namespace voyager
