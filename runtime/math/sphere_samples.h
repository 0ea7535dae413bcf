#pragma once
// Directions and weights that integrate every polynomial of degree 7 or less over the unit sphere
// exactly: the product of two spherical harmonics of degree 3 is one. Gauss-Legendre in z times
// eight equal steps around it. No function of the C library is asked, so that all machines agree.
#include <cmath>

#include "runtime/math/vec.h"

namespace voyager {

inline constexpr int kSphereSamples = 32;

struct SphereSample {
  Vec3d direction;  // unit
  double weight;    // all together are the sphere's surface, 4π
};

// i from 0 to kSphereSamples - 1.
inline SphereSample sphere_sample(int i) {
  constexpr double kPi = 3.14159265358979323846, kDiagonal = 0.70710678118654752440;
  constexpr double kHeight[4] = {-0.86113631159405257522, -0.33998104358485626480,
                                 0.33998104358485626480, 0.86113631159405257522};
  constexpr double kWeight[4] = {0.34785484513745385737, 0.65214515486254614263,
                                 0.65214515486254614263, 0.34785484513745385737};
  constexpr double kCosine[8] = {1, kDiagonal, 0, -kDiagonal, -1, -kDiagonal, 0, kDiagonal};
  const int level = i / 8, step = i % 8;
  const double z = kHeight[level], across = std::sqrt(1 - z * z);
  return {{across * kCosine[step], across * kCosine[(step + 6) % 8], z}, kWeight[level] * kPi / 4};
}

}  // namespace voyager
