#pragma once
// Functions whose last bit differs between C libraries, out of operations that
// IEEE 754 rounds alike everywhere; and small vector algebra.
#include <bit>
#include <cmath>
#include <cstdint>

#include "runtime/math/vec.h"

namespace voyager::synth {

// Natural logarithm of a normal x > 0; relative error near 1e-12.
inline double portable_log(double x) {
  const uint64_t bits = std::bit_cast<uint64_t>(x);
  int exponent = static_cast<int>(bits >> 52) - 1023;
  double m = std::bit_cast<double>((bits & 0xfffffffffffffu) | 0x3ff0000000000000u);
  if (m > 1.4142135623730951) {
    m *= 0.5;
    ++exponent;
  }
  const double a = (m - 1.0) / (m + 1.0), a2 = a * a;
  double sum = 0.0;
  for (int k = 15; k >= 1; k -= 2) sum = sum * a2 + 1.0 / k;
  return 2.0 * a * sum + exponent * 0.6931471805599453;
}

inline double portable_logit(double p) {
  return portable_log(p / (1.0 - p));
}

// |x| <= 6; absolute error below 1e-5, and below 1e-12 for |x| <= 3.
inline double portable_sin(double x) {
  double sum = 0.0;
  for (int k = 23; k >= 1; k -= 2) sum = 1.0 - sum * (x * x) / ((k + 1) * (k + 2.0));
  return x * sum;
}
inline double portable_cos(double x) {
  return portable_sin(x + 1.5707963267948966);
}

inline Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec3d& a) {
  return std::sqrt(dot(a, a));
}
inline Vec3d unit(const Vec3d& a) {
  return (1.0 / length(a)) * a;
}

// The rotation whose matrix has the columns a, b, a x b (a and b unit, at right angles).
inline Quatd frame_rotation(const Vec3d& a, const Vec3d& b) {
  const Vec3d c = cross(a, b);
  const double d[4] = {a.x + b.y + c.z, a.x - b.y - c.z, b.y - a.x - c.z, c.z - a.x - b.y};
  int pivot = 0;
  for (int i = 1; i < 4; ++i)
    if (d[i] > d[pivot]) pivot = i;
  const double p = std::sqrt(1.0 + d[pivot]) / 2.0, f = 1.0 / (4.0 * p);
  switch (pivot) {
    case 0:
      return {p, (b.z - c.y) * f, (c.x - a.z) * f, (a.y - b.x) * f};
    case 1:
      return {(b.z - c.y) * f, p, (b.x + a.y) * f, (c.x + a.z) * f};
    case 2:
      return {(c.x - a.z) * f, (b.x + a.y) * f, p, (c.y + b.z) * f};
    default:
      return {(a.y - b.x) * f, (c.x + a.z) * f, (c.y + b.z) * f, p};
  }
}

}  // namespace voyager::synth
