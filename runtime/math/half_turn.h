#pragma once
// Half turns about an axis, by which axes of formats differ from INRIA's: each is its own inverse,
// and signs are all that changes.
#include <array>
#include <cstddef>

#include "runtime/math/vec.h"

namespace voyager {

struct HalfTurn {
  // That x, y and z take; and those of a quaternion, if the axes of what it turns are turned, too.
  std::array<int, 3> sign{};
  // That SH coefficient k takes: basis k at the turned direction over basis k at the direction.
  std::array<int, 16> sh{};

  template <class T>
  constexpr Vec3<T> operator*(const Vec3<T>& v) const {
    return {turned(v.x, 0), turned(v.y, 1), turned(v.z, 2)};
  }
  // Coordinate `axis`, without -0.
  template <class T>
  constexpr T turned(T value, size_t axis) const {
    return sign[axis] > 0 ? value : T(0) - value;
  }
  // The turn after a rotation, whose own axes then stay as they are.
  template <class T>
  Quat<T> operator*(const Quat<T>& q) const {
    if (sign[0] + sign[1] + sign[2] == 3) return q;
    const auto kept = [&](size_t axis) { return sign[axis] > 0 ? T(1) : T(0); };
    return Quat<T>{T(0), kept(0), kept(1), kept(2)} * q;
  }
  constexpr Mat3d matrix() const {
    return {{{double(sign[0]), 0, 0}, {0, double(sign[1]), 0}, {0, 0, double(sign[2])}}};
  }
  bool operator==(const HalfTurn&) const = default;
};

// Two of the signs are -1, or none. Function m of degree l goes as sin(|m|φ) for m < 0, else as
// cos(mφ), times what in z is even or odd as l - |m| is.
constexpr HalfTurn half_turn(int x, int y, int z) {
  HalfTurn turn{{x, y, z}, {}};
  size_t k = 0;
  for (int l = 0; l <= 3; ++l)
    for (int m = -l; m <= l; ++m, ++k) {
      const int around = m < 0 ? -m : m;
      const int of_y = m < 0 ? y : 1;
      const int of_x = (m < 0 ? around - 1 : around) % 2 != 0 ? x : 1;
      const int of_z = (l - around) % 2 != 0 ? z : 1;
      turn.sh[k] = of_x * of_y * of_z;
    }
  return turn;
}

inline constexpr HalfTurn kNoTurn = half_turn(1, 1, 1);
inline constexpr HalfTurn kHalfTurnX = half_turn(1, -1, -1), kHalfTurnY = half_turn(-1, 1, -1),
                          kHalfTurnZ = half_turn(-1, -1, 1);

}  // namespace voyager
