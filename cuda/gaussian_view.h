#pragma once
// A scene's Gaussians as kernels take them.
#include <cuda_runtime_api.h>

#include <cstdint>

#include "runtime/math/sh.h"

namespace voyager::cuda {

// By Gaussian: by node id, or by address in a pool.
struct GaussianView {
  // Mean, and what bounds the support before all else is read: the largest scale (upper
  // 16 bits) and the radius of the support above the least α* there is, the truth's, in standard
  // deviations, 0 where α never reaches it (lower 16), both rounded up to the upper half of a
  // binary32.
  const float4* hulls;
  const float4* shapes;  // two each: scale and log o; rotation (w, x, y, z)
  // What interpolation reads; null where every leaf is drawn, but for codes of a scene whose
  // footprints differ.
  const float* opacities;
  const uint8_t* node_codes;
  const uint32_t* parents;
  const uint32_t* child_counts;
  // SH coefficients [k][rgb]: binary16 padded to 16 bytes, or binary32.
  const void* coefficients;
  int sh_degree;
  bool half_sh;
  bool doubles;     // nodes of one child are doubles, as files of version 4 have them
  bool footprints;  // that differ between nodes (METHOD §12)
  uint32_t count;
};

// 16-byte words of a Gaussian's coefficients in binary16.
VOYAGER_HD constexpr int half_sh_words(int degree) {
  return (3 * sh_coefficients(degree) + 7) / 8;
}

// Coefficients no larger than this are kept in binary16 on the device: each is then off by
// at most 2⁻⁹ (docs/numerics.md has what that does to colours).
inline constexpr float kMaxHalfCoefficient = 8.0f;

inline constexpr uint32_t coefficient_bytes(int degree, bool half) {
  return half ? 16u * static_cast<uint32_t>(half_sh_words(degree))
              : 12u * static_cast<uint32_t>(sh_coefficients(degree));
}

}  // namespace voyager::cuda
