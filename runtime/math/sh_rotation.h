#pragma once
// Rotated spherical harmonics. sh_basis() is the only word on their order and signs: a coefficient
// of the rotated function is its integral with the basis, over samples that make it exact.
#include "runtime/math/sh.h"
#include "runtime/math/sphere_samples.h"
#include "runtime/math/vec.h"

namespace voyager {

// Of one orthogonal matrix Q, which may be a mirror: determinant -1. Bands do not mix.
struct ShRotation {
  double entry[16][16];  // [to][from], 0 outside the bands
};

inline constexpr int sh_band(int k) {
  return k < 1 ? 0 : k < 4 ? 1 : k < 9 ? 2 : 3;
}

inline ShRotation sh_rotation(const Mat3d& q) {
  ShRotation rotation{};
  for (int i = 0; i < kSphereSamples; ++i) {
    const SphereSample sample = sphere_sample(i);
    const Vec3d& d = sample.direction;
    const Vec3d before = d.x * q.row[0] + d.y * q.row[1] + d.z * q.row[2];  // Qᵀ·d
    double to[16], from[16];
    sh_basis(kMaxShDegree, d, to);
    sh_basis(kMaxShDegree, before, from);
    for (int a = 0; a < 16; ++a)
      for (int b = 0; b < 16; ++b)
        if (sh_band(a) == sh_band(b)) rotation.entry[a][b] += sample.weight * to[a] * from[b];
  }
  return rotation;
}

// Coefficients [k][rgb] of a Gaussian: seen from Q·d they then show what they showed from d.
template <class T>
void rotate_sh(const ShRotation& rotation, int degree, T* sh) {
  T before[48];
  const int count = sh_coefficients(degree);
  for (int i = 3; i < 3 * count; ++i) before[i] = sh[i];
  for (int a = 1; a < count; ++a) {
    const int band = sh_band(a), first = band * band, last = first + 2 * band;
    for (int channel = 0; channel < 3; ++channel) {
      double sum = 0;
      for (int b = first; b <= last; ++b)
        sum += rotation.entry[a][b] * static_cast<double>(before[3 * b + channel]);
      sh[3 * a + channel] = static_cast<T>(sum);
    }
  }
}

}  // namespace voyager
