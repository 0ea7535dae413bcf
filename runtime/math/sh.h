#pragma once
// METHOD §1: c = max(0, 0.5 + Σ SH_k(d)·coef_k), real spherical harmonics in
// the 3DGS basis order and sign. Coefficients are [k][rgb], k = 0 the constant.
#include "runtime/math/vec.h"

namespace voyager {

inline constexpr int kMaxShDegree = 3;
VOYAGER_HD constexpr int sh_coefficients(int degree) {
  return (degree + 1) * (degree + 1);
}

inline constexpr double kSh0 = 0.28209479177387814;

// basis[0 .. (degree+1)^2) for a unit direction.
template <class T>
VOYAGER_HD void sh_basis(int degree, const Vec3<T>& d, T* basis) {
  basis[0] = T(kSh0);
  if (degree < 1) return;
  const T x = d.x, y = d.y, z = d.z;
  basis[1] = T(-0.4886025119029199) * y;
  basis[2] = T(0.4886025119029199) * z;
  basis[3] = T(-0.4886025119029199) * x;
  if (degree < 2) return;
  const T xx = x * x, yy = y * y, zz = z * z, xy = x * y, yz = y * z, xz = x * z;
  basis[4] = T(1.0925484305920792) * xy;
  basis[5] = T(-1.0925484305920792) * yz;
  basis[6] = T(0.31539156525252005) * ((T(2) * zz - xx) - yy);
  basis[7] = T(-1.0925484305920792) * xz;
  basis[8] = T(0.5462742152960396) * (xx - yy);
  if (degree < 3) return;
  basis[9] = T(-0.5900435899266435) * y * (T(3) * xx - yy);
  basis[10] = T(2.890611442640554) * xy * z;
  basis[11] = T(-0.4570457994644658) * y * ((T(4) * zz - xx) - yy);
  basis[12] = T(0.3731763325901154) * z * ((T(2) * zz - T(3) * xx) - T(3) * yy);
  basis[13] = T(-0.4570457994644658) * x * ((T(4) * zz - xx) - yy);
  basis[14] = T(1.445305721320277) * z * (xx - yy);
  basis[15] = T(-0.5900435899266435) * x * (xx - T(3) * yy);
}

// Finite coefficients may sum to infinity, and 0 · ∞ would blend as NaN. Σ of
// the blended weights is at most 1, so a pixel stays finite too.
inline constexpr double kMaxColour = 3e38;

// Coefficient(k, channel) is called for k in order; sums run in that order.
template <class T, class Coefficient>
VOYAGER_HD Vec3<T> sh_colour(int degree, const Vec3<T>& direction, const Coefficient& coefficient) {
  T basis[16];
  sh_basis(degree, direction, basis);
  Vec3<T> c{T(0), T(0), T(0)};
  const int count = sh_coefficients(degree);
  VOYAGER_UNROLL
  for (int k = 0; k < count; ++k) {
    VOYAGER_UNROLL
    for (int channel = 0; channel < 3; ++channel) c[channel] += basis[k] * coefficient(k, channel);
  }
  for (int channel = 0; channel < 3; ++channel) {
    c[channel] += T(0.5);
    c[channel] = c[channel] > T(0) ? c[channel] : T(0);
    c[channel] = c[channel] < T(kMaxColour) ? c[channel] : T(kMaxColour);
  }
  return c;
}

}  // namespace voyager
