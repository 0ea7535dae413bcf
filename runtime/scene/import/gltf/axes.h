#pragma once
// Transforms of glTF's axes (gltf_format.h). SPZ's, right-up-back, are half a turn about y from
// them.
#include "runtime/math/affine.h"
#include "runtime/scene/gltf_format.h"

namespace voyager::gltf {

inline constexpr Mat3d kHalfTurn{{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}};

// A transform between glTF's axes, between INRIA's.
inline Affine in_inria_axes(const Affine& place) {
  return {kHalfTurn * place.linear * kHalfTurn, kHalfTurn * place.offset};
}

}  // namespace voyager::gltf
