#include "cuda/device_scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "cuda/device_gaussian.h"
#include "cuda/device_pool.h"
#include "cuda/upload_made.h"
#include "runtime/frame/scene_sh.h"

namespace voyager::cuda {
namespace {

size_t floats_of(const Scene& scene) {
  return 3 * static_cast<size_t>(scene.coefficients());
}

bool fits_binary16(const Scene& scene, Workers& workers) {
  std::atomic<bool> fits{true};
  workers.for_blocks(scene.gaussians.size(), size_t{1} << 15, [&](size_t begin, size_t end) {
    std::vector<float> sh(floats_of(scene));
    for (size_t i = begin; i < end; ++i) {
      copy_sh(scene, i, sh.data());
      const bool all = std::all_of(sh.begin(), sh.end(), [](float coefficient) {
        return std::fabs(coefficient) <= kMaxHalfCoefficient;
      });
      if (!all) fits.store(false, std::memory_order_relaxed);
    }
  });
  return fits.load();
}

std::vector<float> all_coefficients(const Scene& scene, Workers& workers) {
  std::vector<float> all(scene.gaussians.size() * floats_of(scene));
  workers.for_blocks(scene.gaussians.size(), size_t{1} << 15, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) copy_sh(scene, i, &all[i * floats_of(scene)]);
  });
  return all;
}

}  // namespace

DeviceScene::DeviceScene(const Scene& scene, Workers& workers) {
  upload_gaussians(scene);
  const bool half = upload_coefficients(scene, workers);
  if (footprints_differ(scene)) node_codes_ = upload(std::span<const uint8_t>(scene.node_code));
  view_ = {hulls_.data(),
           shapes_.data(),
           nullptr,
           node_codes_.data(),
           nullptr,
           nullptr,
           half ? static_cast<const void*>(half_coefficients_.data()) : coefficients_.data(),
           scene.sh_degree,
           half,
           scene.doubles,
           footprints_differ(scene),
           static_cast<uint32_t>(hulls_.size())};
}

void DeviceScene::upload_gaussians(const Scene& scene) {
  const auto& gaussians = scene.gaussians;
  const size_t count = gaussians.size();
  hulls_ = upload_made<float4>(count, [&](size_t i) { return device_hull(gaussians[i]); });
  shapes_ = upload_made<float4>(2 * count,
                                [&](size_t i) { return device_shape(gaussians[i / 2], i % 2); });
}

bool DeviceScene::upload_coefficients(const Scene& scene, Workers& workers) {
  if (!fits_binary16(scene, workers)) {
    coefficients_ = upload(std::span<const float>(all_coefficients(scene, workers)));
    return false;
  }
  const size_t stride = 8 * static_cast<size_t>(half_sh_words(scene.sh_degree));
  const size_t count = scene.gaussians.size();
  half_coefficients_ = Buffer<__half>(count * stride);
  std::vector<__half> staging(std::min(count, kUploadBlock) * stride);
  for (size_t first = 0; first < count; first += kUploadBlock) {
    const size_t n = std::min(kUploadBlock, count - first);
    workers.for_blocks(n, 4096, [&](size_t begin, size_t end) {
      std::vector<float> sh(floats_of(scene));
      for (size_t i = begin; i < end; ++i) {
        copy_sh(scene, first + i, sh.data());
        put_half_coefficients(sh.data(), scene.sh_degree, &staging[i * stride]);
      }
    });
    check(cudaMemcpy(half_coefficients_.data() + first * stride, staging.data(),
                     n * stride * sizeof(__half), cudaMemcpyHostToDevice),
          "upload of a scene");
  }
  check(cudaStreamSynchronize(nullptr), "upload of a scene");
  return true;
}

GaussianView DeviceScene::view() const {
  return pool_ == nullptr ? view_ : pool_->gaussians();
}

uint32_t DeviceScene::bytes_a_gaussian() const {
  const GaussianView of = view();
  const uint32_t code = of.footprints ? sizeof(uint8_t) : 0;
  return 3 * sizeof(float4) + code + coefficient_bytes(of.sh_degree, of.half_sh);
}

}  // namespace voyager::cuda
