#pragma once
// A scene's Gaussians as the functors of runtime/stages read them on the device.
#include <cuda_fp16.h>

#include "cuda/device_scene.h"
#include "runtime/stages/interpolate.h"

namespace voyager::cuda {

// A Gaussian's coefficients in registers.
template <int kDegree>
struct HalfSh {
  static constexpr int kWords = half_sh_words(kDegree);
  uint4 words[kWords];

  static __device__ HalfSh load(const GaussianView& gaussians, uint32_t i) {
    HalfSh sh;
    const uint4* from = static_cast<const uint4*>(gaussians.coefficients) + size_t{i} * kWords;
#pragma unroll
    for (int word = 0; word < kWords; ++word) sh.words[word] = __ldg(from + word);
    return sh;
  }
  __device__ float operator()(int k, int channel) const {
    const int at = 3 * k + channel;
    const uint4& word = words[at / 8];
    const uint32_t pair = at % 8 < 2 ? word.x : at % 8 < 4 ? word.y : at % 8 < 6 ? word.z : word.w;
    const auto half = static_cast<unsigned short>(at % 2 == 0 ? pair & 0xffffu : pair >> 16);
    return __half2float(__ushort_as_half(half));
  }
  static __device__ constexpr int degree(const GaussianView&) {
    return kDegree;
  }
};

// Of any degree, read as they are wanted: for the rare scene that binary16 does not fit.
struct FloatSh {
  const float* own;

  static __device__ FloatSh load(const GaussianView& gaussians, uint32_t i) {
    return {static_cast<const float*>(gaussians.coefficients) +
            size_t{i} * 3 * static_cast<size_t>(sh_coefficients(gaussians.sh_degree))};
  }
  __device__ float operator()(int k, int channel) const { return __ldg(own + 3 * k + channel); }
  static __device__ int degree(const GaussianView& gaussians) { return gaussians.sh_degree; }
};

template <class Sh>
struct DeviceArrays {
  GaussianView gaussians;

  __device__ int sh_degree() const { return Sh::degree(gaussians); }
  __device__ Sh sh(uint32_t i) const { return Sh::load(gaussians, i); }
  __device__ int node_code(uint32_t i) const { return __ldg(gaussians.node_codes + i); }
  __device__ bool footprints_differ() const { return gaussians.footprints; }
  __device__ Vec3f mean(uint32_t i) const {
    const float4 hull = __ldg(gaussians.hulls + i);
    return {hull.x, hull.y, hull.z};
  }
  __device__ Gaussian gaussian(uint32_t i) const {
    const float4 a = __ldg(gaussians.shapes + 2 * size_t{i});
    const float4 b = __ldg(gaussians.shapes + 2 * size_t{i} + 1);
    // The opacity is read where it is interpolated: where every leaf is drawn there is no array of
    // it.
    return {{}, 0.0f, {a.x, a.y, a.z}, a.w, {b.x, b.y, b.z, b.w}};
  }
  __device__ float opacity(uint32_t i) const { return __ldg(gaussians.opacities + i); }
};

}  // namespace voyager::cuda
