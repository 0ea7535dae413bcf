#pragma once
// The shape of a Gaussian as compact storage has it (docs/voy-format.md), and as projection reads
// it: 16 bytes for scales, rotation and opacity, and for how many children the node has. Four of
// them are the last word of the Gaussian's SH row (sh_code.h). Host and device restore the same
// bits: what exponentials and logarithms give is looked up in tables that the host makes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "runtime/math/exact.h"
#include "runtime/math/gaussian.h"
#include "runtime/math/half.h"
#include "runtime/math/large_families.h"

namespace voyager {

struct ShapeRest {
  uint16_t rotation[3];  // smaller_component() and which is the largest
  uint8_t node_code;     // runtime/math/node_code.h
  // Of the node, at most kManyChildren. In a device's pool with slots of at most 256 places: the
  // owner code (runtime/select/pool_nodes.h), and the row's spare byte has the count.
  uint8_t children;
};

// A device has the first word beside the mean, since culling reads no more.
struct ShapeCode {
  uint32_t bounds;  // the opacity; from bit 16 on the largest scale; kHasLogit
  ShapeRest rest;
};
static_assert(sizeof(ShapeRest) == 8 && sizeof(ShapeCode) == 12);

// A scale is stored by its logarithm, in kLogScaleSteps a unit from kLeastLogScale on. An opacity
// that has a logit is stored in kOpacitySteps from 0 to 1, another in binary16.
inline constexpr double kLogScaleSteps = 512, kLeastLogScale = -21, kOpacitySteps = 65535;
inline constexpr uint32_t kScaleBits = 15, kScaleMask = (1u << kScaleBits) - 1;
inline constexpr uint32_t kHasLogit = 1u << 31;
inline constexpr size_t kScaleCodes = size_t{1} << kScaleBits, kOpacityCodes = 65536;

// Three scales: the largest, and a word of the others. That names the largest one's axis from bit
// 30 on.
struct ScaleCodes {
  uint32_t largest, others;
};
inline ScaleCodes scale_codes(const std::array<uint32_t, 3>& scales) {
  const auto most = std::max_element(scales.begin(), scales.end());
  const auto axis = static_cast<size_t>(most - scales.begin());
  const uint32_t first = scales[axis == 0 ? 1 : 0], second = scales[axis == 2 ? 1 : 2];
  return {*most, static_cast<uint32_t>(axis) << 30 | second << kScaleBits | first};
}
VOYAGER_HD uint32_t scale_code(const ScaleCodes& codes, uint32_t axis) {
  const uint32_t largest = codes.others >> 30;
  if (axis == largest) return codes.largest;
  const bool first = axis == 0 || (axis == 1 && largest == 0);
  return codes.others >> (first ? 0 : kScaleBits) & kScaleMask;
}

inline uint32_t bounds_code(uint32_t largest_scale, uint32_t opacity, bool has_logit) {
  return (has_logit ? kHasLogit : 0) | largest_scale << 16 | opacity;
}

VOYAGER_HD bool has_logit(const ShapeCode& code) {
  return (code.bounds & kHasLogit) != 0;
}
VOYAGER_HD uint32_t opacity_code(const ShapeCode& code) {
  return code.bounds & 0xffffu;
}
VOYAGER_HD uint32_t largest_scale_code(const ShapeCode& code) {
  return code.bounds >> 16 & kScaleMask;
}

inline float restore_log_scale(uint16_t q) {
  return static_cast<float>(q / kLogScaleSteps + kLeastLogScale);
}

// A leaf's opacity, as a logit. The ends are ±kMaxLogit.
inline float restore_leaf_opacity(uint16_t q) {
  if (q == 0) return -kMaxLogit;
  if (q == 65535) return kMaxLogit;
  return static_cast<float>(std::log(q / (kOpacitySteps - q)));
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
  const float* scale;         // kScaleCodes
  const float* leaf_opacity;  // kOpacityCodes
  const float* log_opacity;   // 2 * kOpacityCodes: of merged Gaussians, then of leaves
};

VOYAGER_HD float restored_opacity(const ShapeCode& code, const ShapeTables& tables) {
  const uint32_t opacity = opacity_code(code);
  return has_logit(code) ? tables.leaf_opacity[opacity]
                         : half_to_float(static_cast<uint16_t>(opacity));
}

VOYAGER_HD float restored_log_opacity(const ShapeCode& code, const ShapeTables& tables) {
  return tables.log_opacity[(has_logit(code) ? kOpacityCodes : 0) + opacity_code(code)];
}

// What normalise() calls for a restored rotation, by its largest component and by its length. Each
// component is 0 or above 2⁻¹⁵, and the divisor is from 0.4 to 2, as a Divisor wants.
VOYAGER_HD Quat<Rounded> divided(const Quat<Rounded>& q, Rounded by) {
  const Divisor divisor(by);
  return {divisor.quotient(q.w), divisor.quotient(q.x), divisor.quotient(q.y),
          divisor.quotient(q.z)};
}

// Without its mean. other_scales: ScaleCodes::others.
VOYAGER_HD Gaussian restored_shape(const ShapeCode& code, uint32_t other_scales,
                                   const ShapeTables& tables) {
  const ScaleCodes scales{largest_scale_code(code), other_scales};
  Gaussian g{};
  g.scale = {tables.scale[scale_code(scales, 0)], tables.scale[scale_code(scales, 1)],
             tables.scale[scale_code(scales, 2)]};
  const Quatf q = restore_rotation(code.rest.rotation);
  const Quat<Rounded> unit = normalise(Quat<Rounded>{q.w, q.x, q.y, q.z});
  g.rotation = {unit.w.value, unit.x.value, unit.y.value, unit.z.value};
  g.opacity = restored_opacity(code, tables);
  g.log_opacity = restored_log_opacity(code, tables);
  return g;
}

}  // namespace voyager
