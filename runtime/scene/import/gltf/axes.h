#pragma once
// glTF's axes and INRIA's: left-up-front against right-down-front, half a turn about z, the same in
// both directions. (SPZ's, right-up-back, are half a turn about y from glTF's.)
#include <array>

#include "runtime/math/affine.h"

namespace voyager::gltf {

// Sign that SH coefficient k takes when x and y are mirrored: that of basis k at (-x, -y, z) over
// basis k at (x, y, z).
inline constexpr std::array<int, 16> kShSign = {1, -1, 1, -1, 1, -1, 1, -1,
                                                1, -1, 1, -1, 1, -1, 1, -1};

inline constexpr Mat3d kHalfTurn{{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}};

// A transform between glTF's axes, between INRIA's.
inline Affine in_inria_axes(const Affine& place) {
  return {kHalfTurn * place.linear * kHalfTurn, kHalfTurn * place.offset};
}

}  // namespace voyager::gltf
