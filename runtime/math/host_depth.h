#pragma once
// How far a host's opaque geometry is, from the values of its depth buffer.
//
// A buffer holds d = a + b / z, so that 1/z runs linearly from 1/far to 1/near:
//   1/z = 1/far + (1/near - 1/far)·t,   t = d where depth is reversed, else 1 - d.
// That is z = b / (d - a) of every such projection, of an infinite far plane too (1/far = 0),
// but all terms are positive: nothing cancels where far / near is large.
#include <cstddef>
#include <limits>

#include "runtime/math/exact.h"

namespace voyager {

// metres: view-space z itself. standard: 0 at near, 1 at far. reversed: 1 at near, 0 at far.
enum class DepthForm { metres, standard, reversed };

struct DepthEncoding {
  DepthForm form = DepthForm::metres;
  float slope = 0, inverse_far = 0;  // of 1/z
};

// 1e-18 <= near <= 1e18 and near < far, which may be infinite; both are of no account to metres.
inline DepthEncoding depth_encoding(DepthForm form, double near, double far) {
  if (form == DepthForm::metres) return {};
  return {form, static_cast<float>((1 - near / far) / near), static_cast<float>(1 / far)};
}

// The z beyond which a splat lies behind the geometry; the same binary32 number wherever it
// is found. d is clamped to the projection's range. Its far value, which buffers are cleared
// to, and NaN are no geometry: +inf. Never NaN.
VOYAGER_HD float depth_limit(const DepthEncoding& encoding, float value) {
  constexpr float kNone = std::numeric_limits<float>::infinity();
  if (encoding.form == DepthForm::metres) return value == value ? value : kNone;
  const float t = encoding.form == DepthForm::standard ? subtract_rn(1.0f, value) : value;
  if (!(t > 0.0f)) return kNone;
  const float slope = multiply_rn(t < 1.0f ? t : 1.0f, encoding.slope);
  return divide_rn(1.0f, add_rn(slope, encoding.inverse_far));
}

// A limit a pixel: rows of an image's width, from the top.
struct DepthLimits {
  const float* values = nullptr;  // null: there are none
  size_t pitch = 0;               // bytes
  DepthEncoding encoding;

  VOYAGER_HD float at(size_t x, size_t y) const {
    const char* row = reinterpret_cast<const char*>(values) + y * pitch;
    return depth_limit(encoding, reinterpret_cast<const float*>(row)[x]);
  }
};

}  // namespace voyager
