#pragma once
// What every importer delivers: the input's own words in INRIA axes
// (x right, y down, z forward) and parameters, before activation
// (runtime/math/gaussian.h). Index i is the i-th accepted Gaussian of the input.
#include <array>
#include <cstdint>
#include <memory_resource>
#include <vector>

#include "runtime/math/gaussian.h"
#include "runtime/math/sh.h"
#include "runtime/scene/native_scale.h"

namespace voyager {

// METHOD §2: an origin is zero where coordinates stay within the reach, in which
// binary32 steps by a millimetre; else a multiple of the step, which is exact to
// subtract from any coordinate nearby. Metres.
inline constexpr double kOriginReach = 16000.0, kOriginStep = 1024.0;

// What was mended or dropped where it entered, and how often.
struct ImportReport {
  uint64_t read = 0;               // Gaussians in the input
  uint64_t dropped_position = 0;   // non-finite or |x| >= 1e18: dropped
  uint64_t dropped_scale = 0;      // NaN or infinite log scale: dropped
  uint64_t repaired_scale = 0;     // outside [ln 1e-9, ln 1e6] m: clamped there
  uint64_t repaired_rotation = 0;  // zero or non-finite: identity
  uint64_t repaired_opacity = 0;  // logit ±inf: ±kMaxLogit; NaN: dropped instead (dropped_opacity)
  uint64_t dropped_opacity = 0;   // NaN logit: dropped
  uint64_t repaired_sh = 0;       // non-finite coefficients: 0
  uint64_t dropped() const { return dropped_position + dropped_scale + dropped_opacity; }
  uint64_t repaired() const {
    return repaired_scale + repaired_rotation + repaired_opacity + repaired_sh;
  }
};

struct GaussianCloud {
  explicit GaussianCloud(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : position(memory), log_scale(memory), rotation(memory), opacity(memory), sh(memory) {}

  size_t size() const { return opacity.size(); }
  int coefficients() const { return sh_coefficients(sh_degree); }
  int input_sh_degree() const { return sh_degree + left_out_bands; }
  GaussianWords words(size_t i) const {
    return {{position[3 * i], position[3 * i + 1], position[3 * i + 2]},
            {log_scale[3 * i], log_scale[3 * i + 1], log_scale[3 * i + 2]},
            {rotation[4 * i], rotation[4 * i + 1], rotation[4 * i + 2], rotation[4 * i + 3]},
            opacity[i]};
  }

  int sh_degree = 0;
  int left_out_bands = 0;  // of the input, above sh_degree: zero in every Gaussian (sh_bands.h)
  NativeScale native;      // as far as the input says
  std::array<double, 3> origin{0, 0, 0};  // world position = origin + position
  std::pmr::vector<float> position;       // 3 a Gaussian, metres
  std::pmr::vector<float> log_scale;      // 3
  std::pmr::vector<float> rotation;       // 4: w, x, y, z; any length
  std::pmr::vector<float> opacity;        // 1: logit (merged Gaussians of a tree: linear)
  std::pmr::vector<float> sh;             // coefficients() * 3: [k][rgb]
  ImportReport report;
};

}  // namespace voyager
