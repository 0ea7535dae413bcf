#pragma once
// The shape of a Gaussian as compact storage has it (docs/voy-format.md), and as projection reads
// it: 16 bytes for scales, rotation and opacity, and for how many children the node has. Host and
// device restore the same bits: what exponentials and logarithms give is looked up in tables that
// the host makes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "runtime/math/exact.h"
#include "runtime/math/gaussian.h"
#include "runtime/math/half.h"
#include "runtime/math/large_families.h"

namespace voyager {

// 16 bytes, so that a device reads it at once.
struct alignas(16) ShapeCode {
  uint16_t scale[3];     // steps of 1/512 of its logarithm, from -21
  uint16_t opacity;      // with a logit: 65535 steps; else binary16
  uint16_t rotation[3];  // smaller_component() and which is the largest
  uint8_t node_code;     // runtime/math/node_code.h
  uint8_t family;        // the node's children, at most kManyChildren; beside them kHasLogit
};
static_assert(sizeof(ShapeCode) == 16);

inline constexpr uint32_t kHasLogit = 0x80;

inline uint8_t family_code(bool has_logit, uint32_t children) {
  return static_cast<uint8_t>((has_logit ? kHasLogit : 0) | std::min(children, kManyChildren));
}
VOYAGER_HD bool has_logit(const ShapeCode& code) {
  return (code.family & kHasLogit) != 0;
}

inline float restore_log_scale(uint16_t q) {
  return static_cast<float>(q / 512.0 - 21.0);
}

// A leaf's opacity, as a logit. The ends are ±kMaxLogit.
inline float restore_leaf_opacity(uint16_t q) {
  if (q == 0) return -kMaxLogit;
  if (q == 65535) return kMaxLogit;
  return static_cast<float>(std::log(q / (65535.0 - q)));
}

// Rotation: the three smaller components of the unit quaternion whose largest is positive, 15 bits
// each in order (w, x, y, z) without the largest; the top bits of the first two words name it.
inline constexpr int kRotationSteps = 16383;
inline constexpr double kRotationRange = 0.70710678118654752;  // a smaller component's bound

namespace detail {

// The largest component that goes with such smaller ones, in binary64.
VOYAGER_HD float largest_component_exactly(const int* steps) {
  double squares = 0;
  for (int i = 0; i < 3; ++i) {
    const double component = steps[i] / double{kRotationSteps} * kRotationRange;
    squares += component * component;
  }
  const double rest = 1.0 - squares;
  return static_cast<float>(std::sqrt(rest > 0.0 ? rest : 0.0));
}

}  // namespace detail

// steps: from -kRotationSteps to kRotationSteps.
VOYAGER_HD float smaller_component(int steps) {
#if defined(__CUDA_ARCH__)
  // The quotient's two halves in binary32; of all steps this is the binary64 result, rounded.
  constexpr float kHigh = static_cast<float>(kRotationRange / kRotationSteps);
  constexpr float kLow = static_cast<float>(kRotationRange / kRotationSteps - double{kHigh});
  const auto x = static_cast<float>(steps);
  return __fmaf_rn(x, kHigh, __fmul_rn(x, kLow));
#else
  return static_cast<float>(steps / double{kRotationSteps} * kRotationRange);
#endif
}

VOYAGER_HD float largest_component(const int* steps) {
#if defined(__CUDA_ARCH__)
  // The root of an integer, to twice the digits of binary32. Binary64, which devices of sm_87 are
  // slow at, only where the result is so near the middle of two numbers that these do not tell.
  constexpr int kAll = 2 * kRotationSteps * kRotationSteps, kHalf = 1 << 27;
  constexpr double kUnit = 1.0 / (kRotationSteps * 1.4142135623730951);
  constexpr float kHigh = static_cast<float>(kUnit);
  constexpr float kLow = static_cast<float>(kUnit - double{kHigh});
  const int rest = kAll - (steps[0] * steps[0] + steps[1] * steps[1] + steps[2] * steps[2]);
  if (rest >= kHalf) {
    const float root = __fsqrt_rn(static_cast<float>(rest));
    const float square = __fmul_rn(root, root), lost = __fmaf_rn(root, root, -square);
    const auto upper = static_cast<float>(rest & ~0xfff), lower = static_cast<float>(rest & 0xfff);
    const float missing = __fsub_rn(__fadd_rn(__fsub_rn(upper, square), lower), lost);
    const float more = __fmul_rn(missing, __fdividef(0.5f, root));
    const float high = __fmul_rn(root, kHigh);
    const float low = __fmaf_rn(more, kHigh, __fmaf_rn(root, kLow, __fmaf_rn(root, kHigh, -high)));
    const float value = __fadd_rn(high, low);
    const float off = fabsf(__fadd_rn(__fsub_rn(high, value), low));
    if (fabsf(off - 0x1p-25f) > 0x1p-38f) return value;
  }
#endif
  return detail::largest_component_exactly(steps);
}

VOYAGER_HD Quatf restore_rotation(const uint16_t* words) {
  const int largest = (words[0] >> 15) | (words[1] >> 15) << 1;
  const int steps[3] = {(words[0] & 0x7fff) - kRotationSteps, (words[1] & 0x7fff) - kRotationSteps,
                        (words[2] & 0x7fff) - kRotationSteps};
  const float a = smaller_component(steps[0]), b = smaller_component(steps[1]),
              c = smaller_component(steps[2]), most = largest_component(steps);
  return {largest == 0 ? most : a,
          largest == 1   ? most
          : largest == 0 ? a
                         : b,
          largest == 2   ? most
          : largest == 3 ? c
                         : b,
          largest == 3 ? most : c};
}

// Of each code: what activate() gives.
struct ShapeTables {
  const float* scale;         // 65536
  const float* leaf_opacity;  // 65536
  const float* log_opacity;   // 2 * 65536: of merged Gaussians, then of leaves
};
inline constexpr size_t kCodes = 65536;

VOYAGER_HD float restored_opacity(const ShapeCode& code, const ShapeTables& tables) {
  return has_logit(code) ? tables.leaf_opacity[code.opacity] : half_to_float(code.opacity);
}

VOYAGER_HD float restored_log_opacity(const ShapeCode& code, const ShapeTables& tables) {
  return tables.log_opacity[(has_logit(code) ? kCodes : 0) + code.opacity];
}

// What normalise() calls for a restored rotation, by its largest component and by its length. Each
// component is 0 or above 2⁻¹⁵, and the divisor is from 0.4 to 2, as a Divisor wants.
VOYAGER_HD Quat<Rounded> divided(const Quat<Rounded>& q, Rounded by) {
  const Divisor divisor(by);
  return {divisor.quotient(q.w), divisor.quotient(q.x), divisor.quotient(q.y),
          divisor.quotient(q.z)};
}

// Without its mean.
VOYAGER_HD Gaussian restored_shape(const ShapeCode& code, const ShapeTables& tables) {
  Gaussian g{};
  g.scale = {tables.scale[code.scale[0]], tables.scale[code.scale[1]], tables.scale[code.scale[2]]};
  const Quatf q = restore_rotation(code.rotation);
  const Quat<Rounded> unit = normalise(Quat<Rounded>{q.w, q.x, q.y, q.z});
  g.rotation = {unit.w.value, unit.x.value, unit.y.value, unit.z.value};
  g.opacity = restored_opacity(code, tables);
  g.log_opacity = restored_log_opacity(code, tables);
  return g;
}

}  // namespace voyager
