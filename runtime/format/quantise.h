#pragma once
// Compact storage, one value at a time. Each pair states the largest error of
// a round trip; docs/voy-format.md repeats them and tests/unit/format/quantise_test.cpp
// holds the code to them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "runtime/format/fold.h"
#include "runtime/math/gaussian.h"
#include "runtime/math/half.h"
#include "runtime/math/sh_code.h"
#include "runtime/math/shape_code.h"
#include "runtime/scene/sanitise.h"

namespace voyager {

// Position along an axis: folded steps from the centre of the node's box, 24 bits.
inline constexpr double kPositionSteps = 8388607.0;

// Error within kPositionSteps of the centre: step / 2, and the rounding of the result
// to binary32.
inline uint32_t quantise_position(float x, double centre, double step) {
  if (step == 0) return 0;
  const double steps =
      std::clamp(std::nearbyint((x - centre) / step), -kPositionSteps, kPositionSteps);
  return fold(static_cast<uint32_t>(static_cast<int32_t>(steps)));
}
inline float restore_position(uint32_t q, double centre, double step) {
  return static_cast<float>(centre + static_cast<int32_t>(unfold(q)) * step);
}

// Log scale: steps of 1/512 from -21. Error 1/1024 (a factor of 1.001 in scale)
// within [-21, 106.99]; sanitised leaves lie inside, merged ones are clamped.
inline uint16_t quantise_log_scale(float log_scale) {
  return static_cast<uint16_t>(
      std::clamp(std::nearbyint((log_scale - kLeastLogScale) * kLogScaleSteps), 0.0, 65535.0));
}

// Rotation (shape_code.h). Error: an angle of 1.6e-4 rad.
inline std::array<uint16_t, 3> quantise_rotation(const Quatf& rotation) {
  const Quatd q = normalise(Quatd{rotation.w, rotation.x, rotation.y, rotation.z});
  const double component[4] = {q.w, q.x, q.y, q.z};
  int largest = 0;
  for (int i = 1; i < 4; ++i)
    if (std::fabs(component[i]) > std::fabs(component[largest])) largest = i;
  const double sign = component[largest] < 0 ? -1.0 : 1.0;
  std::array<uint16_t, 3> out{};
  for (int i = 0, k = 0; i < 4; ++i) {
    if (i == largest) continue;
    const double step = std::nearbyint(sign * component[i] / kRotationRange * kRotationSteps);
    out[static_cast<size_t>(k++)] = static_cast<uint16_t>(
        std::clamp<double>(step, -kRotationSteps, kRotationSteps) + kRotationSteps);
  }
  out[0] = static_cast<uint16_t>(out[0] | (largest & 1) << 15);
  out[1] = static_cast<uint16_t>(out[1] | (largest >> 1) << 15);
  return out;
}

// A leaf's opacity: 65535 steps of its sigmoid. Error: half a step (7.7e-6) of
// opacity. The ends are ±kMaxLogit.
inline uint16_t quantise_leaf_opacity(float logit_word) {
  const double opacity = 1.0 / (1.0 + std::exp(-static_cast<double>(logit_word)));
  return static_cast<uint16_t>(std::nearbyint(opacity * kOpacitySteps));
}
}  // namespace voyager
