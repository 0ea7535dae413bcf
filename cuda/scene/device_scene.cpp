#include "cuda/scene/device_scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "cuda/device/upload_made.h"
#include "cuda/scene/device_gaussian.h"
#include "cuda/stream/device_pool.h"
#include "runtime/frame/scene_gaussians.h"

namespace voyager::cuda {
namespace {

bool fits_binary16(const Scene& scene, Workers& workers) {
  std::atomic<bool> fits{true};
  workers.for_blocks(scene.gaussians.size(), size_t{1} << 15, [&](size_t begin, size_t end) {
    const auto first = scene.sh.begin();
    const auto at = [&](size_t i) {
      return first + static_cast<std::ptrdiff_t>(i * sh_floats(scene));
    };
    const bool all = std::all_of(at(begin), at(end), [](float coefficient) {
      return std::fabs(coefficient) <= kMaxHalfCoefficient;
    });
    if (!all) fits.store(false, std::memory_order_relaxed);
  });
  return fits.load();
}

}  // namespace

DeviceScene::DeviceScene(const Device& device, const Scene& scene, Workers& workers) {
  view_.sh_degree = scene.sh_degree;
  view_.doubles = scene.doubles;
  view_.footprints = footprints_differ(scene);
  view_.count = static_cast<uint32_t>(gaussian_count(scene));
  if (is_coded(scene))
    upload_codes(device, scene);
  else
    upload_floats(scene, workers);
}

void DeviceScene::upload_codes(const Device& device, const Scene& scene) {
  std::vector<ShStepSizes> steps;
  for (const ShScales& scales : scene.sh_scales) steps.push_back(step_sizes(scales));
  const size_t count = scene.shapes.size();
  allocate_together(ToAllocate{coded_hulls_, count}, ToAllocate{shape_codes_, count},
                    ToAllocate{sh_rows_, scene.sh_rows.size()}, ToAllocate{sh_steps_, steps.size()},
                    ToAllocate{mean_grids_, scene.mean_grids.size()},
                    ToAllocate{group_blocks_, scene.group_blocks.size()});
  upload_made(coded_hulls_, [&](size_t i) {
    return CodedHull{scene.mean_codes[i], scene.shapes[i].bounds};
  });
  upload_made(shape_codes_, [&](size_t i) { return scene.shapes[i].rest; });
  upload<uint8_t>(scene.sh_rows, sh_rows_);
  upload<ShStepSizes>(steps, sh_steps_);
  upload<MeanGrid>(scene.mean_grids, mean_grids_);
  upload<RunBlock>(scene.group_blocks, group_blocks_);
  tables_ = device.code_tables();
  view_.hulls = coded_hulls_.data();
  view_.shapes = shape_codes_.data();
  view_.coefficients = sh_rows_.data();
  view_.sh_form = ShForm::coded;
  view_.tables = tables_->view();
  view_.sh_steps = sh_steps_.data();
  view_.mean_grids = mean_grids_.data();
  view_.code_groups = {group_blocks_.data(), 0};
}

void DeviceScene::upload_floats(const Scene& scene, Workers& workers) {
  const size_t count = scene.gaussians.size();
  const bool half = fits_binary16(scene, workers);
  const size_t stride = 8 * static_cast<size_t>(half_sh_words(scene.sh_degree));
  allocate_together(ToAllocate{hulls_, count}, ToAllocate{shapes_, 2 * count},
                    ToAllocate{half_coefficients_, half ? count * stride : 0},
                    ToAllocate{coefficients_, half ? 0 : scene.sh.size()},
                    ToAllocate{node_codes_, footprints_differ(scene) ? scene.node_code.size() : 0});
  upload_made(hulls_, [&](size_t i) { return device_hull(scene.gaussians[i]); });
  upload_made(shapes_, [&](size_t i) { return device_shape(scene.gaussians[i / 2], i % 2); });
  if (half)
    upload_half_coefficients(scene, workers);
  else
    upload<float>(scene.sh, coefficients_);
  if (node_codes_.size() != 0) upload<uint8_t>(scene.node_code, node_codes_);
  view_.hulls = hulls_.data();
  view_.shapes = shapes_.data();
  view_.node_codes = node_codes_.data();
  view_.coefficients =
      half ? static_cast<const void*>(half_coefficients_.data()) : coefficients_.data();
  view_.sh_form = half ? ShForm::half : ShForm::single;
}

void DeviceScene::upload_half_coefficients(const Scene& scene, Workers& workers) {
  const size_t stride = 8 * static_cast<size_t>(half_sh_words(scene.sh_degree));
  const size_t count = scene.gaussians.size();
  std::vector<__half> staging(std::min(count, kUploadBlock) * stride);
  for (size_t first = 0; first < count; first += kUploadBlock) {
    const size_t n = std::min(kUploadBlock, count - first);
    workers.for_blocks(n, 4096, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i)
        put_half_coefficients(&scene.sh[(first + i) * sh_floats(scene)], scene.sh_degree,
                              &staging[i * stride]);
    });
    check(cudaMemcpy(half_coefficients_.data() + first * stride, staging.data(),
                     n * stride * sizeof(__half), cudaMemcpyHostToDevice),
          "upload of a scene");
  }
  check(cudaStreamSynchronize(nullptr), "upload of a scene");
}

GaussianView DeviceScene::view() const {
  return pool_ == nullptr ? view_ : pool_->gaussians();
}

uint32_t DeviceScene::bytes_a_gaussian() const {
  const GaussianView of = view();
  const uint32_t code = of.footprints && of.sh_form != ShForm::coded ? sizeof(uint8_t) : 0;
  return hull_bytes(of.sh_form) + shape_bytes(of.sh_form) + code +
         coefficient_bytes(of.sh_degree, of.sh_form);
}

}  // namespace voyager::cuda
