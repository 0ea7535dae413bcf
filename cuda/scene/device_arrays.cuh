#pragma once
// A scene's Gaussians as the functors of runtime/stages read them on the device.
#include <cuda_fp16.h>

#include "cuda/scene/device_scene.h"
#include "cuda/scene/gaussian_hull.cuh"
#include "runtime/stages/interpolate.h"

namespace voyager::cuda {

// A Gaussian's coefficients in registers.
template <int kDegree>
struct HalfSh {
  static constexpr bool kCoded = false;
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
  static constexpr bool kCoded = false;
  const float* own;

  static __device__ FloatSh load(const GaussianView& gaussians, uint32_t i) {
    return {static_cast<const float*>(gaussians.coefficients) +
            size_t{i} * 3 * static_cast<size_t>(sh_coefficients(gaussians.sh_degree))};
  }
  __device__ float operator()(int k, int channel) const { return __ldg(own + 3 * k + channel); }
  static __device__ int degree(const GaussianView& gaussians) { return gaussians.sh_degree; }
};

// A row of sh_code.h, restored as it is read.
template <int kDegree>
struct CodedSh {
  static constexpr bool kCoded = true;
  static constexpr int kWords = sh_row_bytes(kDegree) / sizeof(uint32_t);
  uint32_t words[kWords];
  float high[3], low[3];

  static __device__ CodedSh load(const GaussianView& gaussians, uint32_t i) {
    CodedSh sh;
    if constexpr (kDegree < 2) {
      const uint32_t* from = row(gaussians, i);
#pragma unroll
      for (int word = 0; word < kWords - 1; ++word) sh.words[word] = __ldg(from + word);
    } else {
      const auto* from = reinterpret_cast<const uint4*>(row(gaussians, i));
#pragma unroll
      for (int word = 0; word < kDegree; ++word) {
        const uint4 four = __ldg(from + word);
        sh.words[4 * word] = four.x, sh.words[4 * word + 1] = four.y;
        sh.words[4 * word + 2] = four.z, sh.words[4 * word + 3] = four.w;
      }
    }
    if constexpr (kDegree != 0) {
      const auto* sizes =
          reinterpret_cast<const float4*>(gaussians.sh_steps + gaussians.code_groups(i));
      const float4 first = __ldg(sizes), second = __ldg(sizes + 1);
      sh.high[0] = first.x, sh.high[1] = first.y, sh.high[2] = first.z;
      sh.low[0] = first.w, sh.low[1] = second.x, sh.low[2] = second.y;
    }
    return sh;
  }
  __device__ float operator()(int k, int channel) const {
    const int at = 3 * k + channel;
    if (k == 0) {
      const uint32_t pair = words[at / 2];
      return __half2float(
          __ushort_as_half(static_cast<unsigned short>(at % 2 == 0 ? pair & 0xffffu : pair >> 16)));
    }
    // An integer in the last bits of 2^23 is that much above it, and one that is `up` bits higher
    // is above 2^(23 - up), so that few steps need a shift.
    float step;
    if (k < kShBandStart[1]) {
      const int byte = kShBandOneAt + at - 3 * kShBandStart[0];
      const uint32_t bits =
          __byte_perm(words[byte / 4] ^ 0x80808080u, 0x4b000000u, 0x7440u | byte % 4);
      step = __uint_as_float(bits) - (0x1p23f + 128.0f);
    } else {
      const int first = 8 * kShSixBitsAt + 6 * (at - 3 * kShBandStart[1]);
      const int word = first / 32, bit = first % 32;
      const bool unshifted = bit <= 23 - 6, split = bit > 32 - 6;
      const int up = unshifted ? bit : 0;
      const uint32_t own =
          split ? __funnelshift_r(words[word], words[word + 1], static_cast<uint32_t>(bit))
                : words[word] >> (bit - up);
      const uint32_t bits = own & 63u << up;
      const uint32_t base = static_cast<uint32_t>(127 + 23 - up) << 23;
      step = __uint_as_float(base | bits) - (__uint_as_float(base) + static_cast<float>(kShOffset));
    }
    const int band = k < kShBandStart[1] ? 0 : k < kShBandStart[2] ? 1 : 2;
    return __fmaf_rn(step, high[band], __fmul_rn(step, low[band]));
  }
  static __device__ const uint32_t* row(const GaussianView& gaussians, uint32_t i) {
    return static_cast<const uint32_t*>(gaussians.coefficients) + size_t{i} * kWords;
  }
  static __device__ uint32_t last_word(const GaussianView& gaussians, uint32_t i) {
    return __ldg(row(gaussians, i) + kWords - 1);
  }
  static __device__ constexpr int degree(const GaussianView&) {
    return kDegree;
  }
};

template <class Sh>
struct DeviceArrays {
  GaussianView gaussians;

  __device__ int sh_degree() const { return Sh::degree(gaussians); }
  __device__ Sh sh(uint32_t i) const { return Sh::load(gaussians, i); }
  __device__ int node_code(uint32_t i) const {
    if constexpr (Sh::kCoded) return __ldg(&rest(i)->node_code);
    return __ldg(gaussians.node_codes + i);
  }
  __device__ bool footprints_differ() const { return gaussians.footprints; }
  __device__ Vec3f mean(uint32_t i) const {
    if constexpr (Sh::kCoded) return coded_mean(gaussians, i);
    const float4 hull = float_hull(gaussians, i);
    return {hull.x, hull.y, hull.z};
  }
  __device__ Gaussian gaussian(uint32_t i) const {
    if constexpr (Sh::kCoded)
      return restored_shape(code(i), Sh::last_word(gaussians, i), gaussians.tables);
    const float4* const shapes = static_cast<const float4*>(gaussians.shapes) + 2 * size_t{i};
    const float4 a = __ldg(shapes), b = __ldg(shapes + 1);
    // The opacity is read where it is interpolated: where every leaf is drawn there is no array of
    // it.
    return {{}, 0.0f, {a.x, a.y, a.z}, a.w, {b.x, b.y, b.z, b.w}};
  }
  __device__ float opacity(uint32_t i) const {
    if constexpr (Sh::kCoded) return restored_opacity(code(i), gaussians.tables);
    return __ldg(gaussians.opacities + i);
  }

 private:
  __device__ const ShapeRest* rest(uint32_t i) const {
    return static_cast<const ShapeRest*>(gaussians.shapes) + i;
  }
  __device__ ShapeCode code(uint32_t i) const {
    const uint2 w = __ldg(static_cast<const uint2*>(gaussians.shapes) + i);
    ShapeCode code;
    code.bounds = coded_bounds(gaussians, i);
    code.rest.rotation[0] = static_cast<uint16_t>(w.x);
    code.rest.rotation[1] = static_cast<uint16_t>(w.x >> 16);
    code.rest.rotation[2] = static_cast<uint16_t>(w.y);
    code.rest.node_code = static_cast<uint8_t>(w.y >> 16);
    code.rest.children = static_cast<uint8_t>(w.y >> 24);
    return code;
  }
};

// Calls visit.template operator()<Sh>() with the scene's.
template <class Visit>
void with_sh(const GaussianView& gaussians, const Visit& visit) {
  const bool coded = gaussians.sh_form == ShForm::coded;
  if (gaussians.sh_form == ShForm::single) return visit.template operator()<FloatSh>();
  switch (gaussians.sh_degree) {
    case 0:
      return coded ? visit.template operator()<CodedSh<0>>()
                   : visit.template operator()<HalfSh<0>>();
    case 1:
      return coded ? visit.template operator()<CodedSh<1>>()
                   : visit.template operator()<HalfSh<1>>();
    case 2:
      return coded ? visit.template operator()<CodedSh<2>>()
                   : visit.template operator()<HalfSh<2>>();
    default:
      return coded ? visit.template operator()<CodedSh<3>>()
                   : visit.template operator()<HalfSh<3>>();
  }
}

}  // namespace voyager::cuda
