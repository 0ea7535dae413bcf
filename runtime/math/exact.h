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
