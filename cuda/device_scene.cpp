#include "cuda/device_scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "runtime/stages/project.h"

namespace voyager::cuda {
namespace {

constexpr size_t kUploadBlock = size_t{1} << 18;  // Gaussians at a time through a host buffer

// count[i] by make(i), block by block.
template <class T, class Make>
Buffer<T> upload_made(size_t count, size_t block, const Make& make) {
  Buffer<T> buffer(count);
  std::vector<T> staging(std::min(count, block));
  for (size_t first = 0; first < count; first += block) {
    const size_t n = std::min(block, count - first);
    for (size_t i = 0; i < n; ++i) staging[i] = make(first + i);
    check(cudaMemcpy(buffer.data() + first, staging.data(), n * sizeof(T), cudaMemcpyHostToDevice),
          "upload of a scene");
  }
  check(cudaStreamSynchronize(nullptr), "upload of a scene");
  return buffer;
}

// x ≥ 0, rounded up to 16 bits of a binary32.
uint32_t upper_half(float x) {
  return (float_bits(x) + 0xffffu) >> 16;
}

float support_radius_of(float log_opacity) {
  const float rho = rho_min(log_opacity);
  return rho <= 0.0f ? std::sqrt(2.0f * (kRhoMargin - rho)) : 0.0f;
}

float4 hull_of(const Gaussian& g) {
  const uint32_t bounds =
      upper_half(detail::largest(g.scale)) << 16 | upper_half(support_radius_of(g.log_opacity));
  return {g.mean.x, g.mean.y, g.mean.z, bits_float(bounds)};
}

bool fits_binary16(const Scene& scene, Workers& workers) {
  std::atomic<bool> fits{true};
  workers.for_blocks(scene.sh.size(), size_t{1} << 20, [&](size_t begin, size_t end) {
    const bool all = std::all_of(
        scene.sh.begin() + static_cast<std::ptrdiff_t>(begin),
        scene.sh.begin() + static_cast<std::ptrdiff_t>(end),
        [](float coefficient) { return std::fabs(coefficient) <= kMaxHalfCoefficient; });
    if (!all) fits.store(false, std::memory_order_relaxed);
  });
  return fits.load();
}

}  // namespace

DeviceScene::DeviceScene(const Scene& scene, Workers& workers) : sh_degree_(scene.sh_degree) {
  upload_gaussians(scene);
  upload_coefficients(scene, workers);
  if (scene.flat()) return;
  axis_codes_ = upload(std::span<const uint8_t>(scene.axis_code));
  parents_ = upload(std::span<const uint32_t>(scene.tree.parent));
  child_counts_ = upload_made<uint32_t>(
      scene.tree.size(), kUploadBlock, [&](size_t i) { return scene.tree.records[i].child_count; });
}

void DeviceScene::upload_gaussians(const Scene& scene) {
  const auto& gaussians = scene.gaussians;
  const size_t count = gaussians.size();
  hulls_ =
      upload_made<float4>(count, kUploadBlock, [&](size_t i) { return hull_of(gaussians[i]); });
  shapes_ = upload_made<float4>(2 * count, kUploadBlock, [&](size_t i) -> float4 {
    const Gaussian& g = gaussians[i / 2];
    if (i % 2 == 0) return {g.scale.x, g.scale.y, g.scale.z, g.log_opacity};
    return {g.rotation.w, g.rotation.x, g.rotation.y, g.rotation.z};
  });
  if (!scene.flat())
    opacities_ =
        upload_made<float>(count, kUploadBlock, [&](size_t i) { return gaussians[i].opacity; });
}

void DeviceScene::upload_coefficients(const Scene& scene, Workers& workers) {
  half_sh_ = fits_binary16(scene, workers);
  if (!half_sh_) {
    coefficients_ = upload(std::span<const float>(scene.sh));
    return;
  }
  const size_t used = 3 * static_cast<size_t>(scene.coefficients());
  const size_t stride = 8 * static_cast<size_t>(half_sh_words(scene.sh_degree));
  const size_t count = scene.gaussians.size();
  half_coefficients_ = Buffer<__half>(count * stride);
  std::vector<__half> staging(std::min(count, kUploadBlock) * stride, __float2half_rn(0.0f));
  for (size_t first = 0; first < count; first += kUploadBlock) {
    const size_t n = std::min(kUploadBlock, count - first);
    workers.for_blocks(n, 4096, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i)
        for (size_t k = 0; k < used; ++k)
          staging[i * stride + k] = __float2half_rn(scene.sh[(first + i) * used + k]);
    });
    check(cudaMemcpy(half_coefficients_.data() + first * stride, staging.data(),
                     n * stride * sizeof(__half), cudaMemcpyHostToDevice),
          "upload of a scene");
  }
  check(cudaStreamSynchronize(nullptr), "upload of a scene");
}

GaussianView DeviceScene::view() const {
  return {hulls_.data(),
          shapes_.data(),
          opacities_.data(),
          axis_codes_.data(),
          parents_.data(),
          child_counts_.data(),
          half_sh_ ? static_cast<const void*>(half_coefficients_.data()) : coefficients_.data(),
          sh_degree_,
          half_sh_,
          static_cast<uint32_t>(hulls_.size())};
}

uint32_t DeviceScene::bytes_a_gaussian() const {
  const auto coefficients = half_sh_ ? 16u * static_cast<uint32_t>(half_sh_words(sh_degree_))
                                     : 12u * static_cast<uint32_t>(sh_coefficients(sh_degree_));
  return 3 * sizeof(float4) + coefficients;
}

}  // namespace voyager::cuda
