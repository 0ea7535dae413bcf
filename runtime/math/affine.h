#pragma once
// x -> linear·x + offset, and rotations as matrix and quaternion.
#include <cmath>

#include "runtime/math/vec.h"

namespace voyager {

inline constexpr Mat3d kIdentity{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
// To INRIA's axes from those with x right, y forward and z up.
inline constexpr Mat3d kFromZUp{{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};

struct Affine {
  Mat3d linear = kIdentity;
  Vec3d offset{0, 0, 0};

  Vec3d operator*(const Vec3d& x) const { return linear * x + offset; }
  bool operator==(const Affine&) const = default;
};

inline Mat3d transposed(const Mat3d& m) {
  return {{{m.row[0].x, m.row[1].x, m.row[2].x},
           {m.row[0].y, m.row[1].y, m.row[2].y},
           {m.row[0].z, m.row[1].z, m.row[2].z}}};
}

inline Mat3d operator*(const Mat3d& a, const Mat3d& b) {
  const Mat3d columns = transposed(b);
  Mat3d product;
  for (int i = 0; i < 3; ++i) product.row[i] = columns * a.row[i];
  return product;
}

// First `b`, then `a`.
inline Affine operator*(const Affine& a, const Affine& b) {
  return {a.linear * b.linear, a * b.offset};
}

inline double determinant(const Mat3d& m) {
  return dot(m.row[0], cross(m.row[1], m.row[2]));
}

// Of a matrix that is not singular.
inline Affine inverse(const Affine& a) {
  const auto& row = a.linear.row;
  const double share = 1 / determinant(a.linear);
  const Mat3d linear = transposed({{share * cross(row[1], row[2]), share * cross(row[2], row[0]),
                                    share * cross(row[0], row[1])}});
  return {linear, -1.0 * (linear * a.offset)};
}

// The unit quaternion of a rotation matrix, up to its sign: from the largest of the four
// components, so that nothing cancels.
inline Quatd quaternion_of(const Mat3d& m) {
  const double xx = m.row[0].x, yy = m.row[1].y, zz = m.row[2].z;
  const double x = m.row[2].y - m.row[1].z, y = m.row[0].z - m.row[2].x,
               z = m.row[1].x - m.row[0].y;
  const double xy = m.row[0].y + m.row[1].x, xz = m.row[0].z + m.row[2].x,
               yz = m.row[1].z + m.row[2].y;
  const double w4 = 1 + xx + yy + zz, x4 = 1 + xx - yy - zz, y4 = 1 - xx + yy - zz,
               z4 = 1 - xx - yy + zz;
  if (w4 >= x4 && w4 >= y4 && w4 >= z4) return normalise(Quatd{w4, x, y, z});
  if (x4 >= y4 && x4 >= z4) return normalise(Quatd{x, x4, xy, xz});
  if (y4 >= z4) return normalise(Quatd{y, xy, y4, yz});
  return normalise(Quatd{z, xz, yz, z4});
}

}  // namespace voyager
