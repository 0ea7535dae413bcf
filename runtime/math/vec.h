#pragma once
#include <cmath>

#include "runtime/math/host_device.h"

namespace voyager {

template <class T>
struct Vec3 {
  T x, y, z;
  VOYAGER_HD T& operator[](int i) { return (&x)[i]; }
  VOYAGER_HD const T& operator[](int i) const { return (&x)[i]; }
  bool operator==(const Vec3&) const = default;
};
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <class T>
VOYAGER_HD Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
VOYAGER_HD Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
VOYAGER_HD Vec3<T> operator*(T s, const Vec3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
VOYAGER_HD T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

template <class T>
VOYAGER_HD Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Rows.
template <class T>
struct Mat3 {
  Vec3<T> row[3];
  bool operator==(const Mat3&) const = default;
  VOYAGER_HD Vec3<T> operator*(const Vec3<T>& v) const {
    return {dot(row[0], v), dot(row[1], v), dot(row[2], v)};
  }
};
using Mat3f = Mat3<float>;
using Mat3d = Mat3<double>;

// Quaternion in (w, x, y, z) order, as everywhere below the C ABI.
template <class T>
struct Quat {
  T w, x, y, z;
};
using Quatf = Quat<float>;
using Quatd = Quat<double>;

template <class T>
VOYAGER_HD Quat<T> divided(const Quat<T>& q, T by) {
  return {q.w / by, q.x / by, q.y / by, q.z / by};
}

// Scales by the largest component first: no overflow or underflow on the way.
// A zero or non-finite quaternion gives the identity.
template <class T>
VOYAGER_HD Quat<T> normalise(const Quat<T>& q) {
  using std::fabs, std::sqrt;
  T largest = fabs(q.w);
  largest = fabs(q.x) > largest ? fabs(q.x) : largest;
  largest = fabs(q.y) > largest ? fabs(q.y) : largest;
  largest = fabs(q.z) > largest ? fabs(q.z) : largest;
  if (!(largest > T(0)) || !(T(3.0e38f) > largest)) return {T(1), T(0), T(0), T(0)};
  const Quat<T> u = divided(q, largest);
  const T length = sqrt(((u.w * u.w + u.x * u.x) + u.y * u.y) + u.z * u.z);
  return divided(u, length);
}

template <class T>
VOYAGER_HD Quat<T> operator*(const Quat<T>& a, const Quat<T>& b) {
  return {((a.w * b.w - a.x * b.x) - a.y * b.y) - a.z * b.z,
          ((a.w * b.x + a.x * b.w) + a.y * b.z) - a.z * b.y,
          ((a.w * b.y - a.x * b.z) + a.y * b.w) + a.z * b.x,
          ((a.w * b.z + a.x * b.y) - a.y * b.x) + a.z * b.w};
}

// Rotation matrix of a unit quaternion.
template <class T>
VOYAGER_HD Mat3<T> rotation(const Quat<T>& q) {
  const T xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const T xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const T wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  return {{{T(1) - T(2) * (yy + zz), T(2) * (xy - wz), T(2) * (xz + wy)},
           {T(2) * (xy + wz), T(1) - T(2) * (xx + zz), T(2) * (yz - wx)},
           {T(2) * (xz - wy), T(2) * (yz + wx), T(1) - T(2) * (xx + yy)}}};
}

}  // namespace voyager
