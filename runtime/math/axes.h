#pragma once
// METHOD §2: an eigen-decomposition leaves the order and signs of a Gaussian's
// axes free; the 24 proper rotations of the cube are the choices. An axis code
// (0-23, 0 is the identity) names one: the Gaussian (scale, rotation) is the
// same as (permuted scale, rotation * cube_rotation(code)).
#include "runtime/math/vec.h"

namespace voyager {

inline constexpr int kAxisCodes = 24;

struct AxisCode {
  // Column i of the turned rotation is sign[i] times column from[i] of the old one.
  signed char from[3];
  signed char sign[3];
};

// Even permutations take an even number of minus signs, odd ones an odd
// number, so that the determinant stays +1.
VOYAGER_HD AxisCode axis_code(int code) {
  const signed char permutations[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                          {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  const int permutation = code / 4, bits = code % 4;
  AxisCode a;
  for (int i = 0; i < 3; ++i) a.from[i] = permutations[permutation][i];
  const signed char parity = permutation < 3 ? 1 : -1;
  a.sign[0] = (bits & 1) ? -1 : 1;
  a.sign[1] = (bits & 2) ? -1 : 1;
  a.sign[2] = static_cast<signed char>(parity * a.sign[0] * a.sign[1]);
  return a;
}

template <class T>
VOYAGER_HD Vec3<T> turn_scale(const Vec3<T>& s, int code) {
  const AxisCode a = axis_code(code);
  return {s[a.from[0]], s[a.from[1]], s[a.from[2]]};
}

// Unit quaternion of the cube rotation whose matrix has column i = sign[i]
// e_from[i]: 1, 2 or 4 components of equal size (tests hold the table to axis_code).
template <class T>
VOYAGER_HD Quat<T> cube_rotation(int code) {
  const signed char sign[kAxisCodes][4] = {
      {1, 0, 0, 0},    {0, 0, 1, 0},   {0, 1, 0, 0},   {0, 0, 0, 1},    // x y z
      {1, 1, 1, 1},    {1, 1, -1, -1}, {1, -1, -1, 1}, {1, -1, 1, -1},  // y z x
      {1, -1, -1, -1}, {1, 1, 1, -1},  {1, 1, -1, 1},  {1, -1, 1, 1},   // z x y
      {1, 1, 0, 0},    {0, 0, 1, 1},   {1, -1, 0, 0},  {0, 0, 1, -1},   // x z y
      {1, 0, -1, 0},   {1, 0, 1, 0},   {0, 1, 0, 1},   {0, 1, 0, -1},   // z y x
      {0, 1, 1, 0},    {1, 0, 0, -1},  {1, 0, 0, 1},   {0, 1, -1, 0}};  // y x z
  const T size = code < 4 ? T(1) : (code < 12 ? T(0.5) : T(0.70710678118654752440));
  const signed char* s = sign[code];
  return {size * T(s[0]), size * T(s[1]), size * T(s[2]), size * T(s[3])};
}

// The code whose turned rotation is nearest the parent's (largest |dot|; the
// lowest code wins a tie). Both unit.
VOYAGER_HD int nearest_axis_code(const Quatd& parent, const Quatd& child) {
  // dot(parent, child * cube) = dot(conjugate(child) * parent, cube).
  const Quatd turn = Quatd{child.w, -child.x, -child.y, -child.z} * parent;
  int best = 0;
  double most = -1.0;
  for (int code = 0; code < kAxisCodes; ++code) {
    const Quatd q = cube_rotation<double>(code);
    const double d = std::fabs(((turn.w * q.w + turn.x * q.x) + turn.y * q.y) + turn.z * q.z);
    if (d > most + 1e-12) {
      most = d;
      best = code;
    }
  }
  return best;
}

}  // namespace voyager
