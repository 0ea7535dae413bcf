#pragma once
// METHOD §5 as it is usually written, in any precision: the covariance as a product of
// matrices, its determinant as a difference, an expanded conic. What a rewrite must beat.
#include "runtime/math/projection.h"

namespace voyager::test {

template <class T>
struct TextbookConic {
  T xx, xy, yy, determinant;

  T rho(T dx, T dy) const {
    return T(-0.5) * (yy * dx * dx + xx * dy * dy - T(2) * xy * dx * dy) / determinant;
  }
};

template <class T>
TextbookConic<T> textbook_conic(const ImageJacobian<T>& j, const Quat<T>& q, const Vec3<T>& s) {
  const Mat3<T> r = rotation(q);
  Mat3<T> sigma{};
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      for (int k = 0; k < 3; ++k) sigma.row[a][b] += (r.row[a][k] * s[k]) * (r.row[b][k] * s[k]);
  const Vec3<T> x = sigma * j.x, y = sigma * j.y;
  const T xx = dot(j.x, x) + T(kLowPass), xy = dot(j.x, y), yy = dot(j.y, y) + T(kLowPass);
  return {xx, xy, yy, xx * yy - xy * xy};
}

}  // namespace voyager::test
