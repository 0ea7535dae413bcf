#pragma once
// A scene's Gaussians on the device: shared by all views of the scene.
#include <cuda_fp16.h>

#include <memory>

#include "cuda/buffer.h"
#include "runtime/base/workers.h"
#include "runtime/frame/scene.h"

namespace voyager::cuda {

// As kernels take it, by Gaussian.
struct GaussianView {
  // Mean, and what bounds the support before all else is read: the largest scale (upper
  // 16 bits) and the radius of the support in standard deviations, 0 where α never
  // reaches α* (lower 16), both rounded up to the upper half of a binary32.
  const float4* hulls;
  const float4* shapes;  // two each: scale and log o; rotation (w, x, y, z)
  const float* opacities;
  // Of a tree; null for a flat scene.
  const uint8_t* axis_codes;
  const uint32_t* parents;
  const uint32_t* child_counts;
  // SH coefficients [k][rgb]: binary16 padded to 16 bytes, or binary32.
  const void* coefficients;
  int sh_degree;
  bool half_sh;
  uint32_t count;
};

// 16-byte words of a Gaussian's coefficients in binary16.
VOYAGER_HD constexpr int half_sh_words(int degree) {
  return (3 * sh_coefficients(degree) + 7) / 8;
}

// Coefficients no larger than this are kept in binary16 on the device: each is then off by
// at most 2⁻⁹ (docs/numerics.md has what that does to colours).
inline constexpr float kMaxHalfCoefficient = 8.0f;

class DeviceScene {
 public:
  DeviceScene(const Scene& scene, Workers& workers);

  GaussianView view() const;
  // Stored bytes that projection reads of a Gaussian that is visible.
  uint32_t bytes_a_gaussian() const;

 private:
  void upload_gaussians(const Scene& scene);
  void upload_coefficients(const Scene& scene, Workers& workers);

  Buffer<float4> hulls_, shapes_;
  Buffer<float> opacities_;
  Buffer<uint8_t> axis_codes_;
  Buffer<uint32_t> parents_, child_counts_;
  Buffer<__half> half_coefficients_;
  Buffer<float> coefficients_;
  int sh_degree_;
  bool half_sh_ = false;
};

}  // namespace voyager::cuda
