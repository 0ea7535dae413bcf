#pragma once
// A scene's Gaussians on the device: shared by all views of the scene.
#include <cuda_fp16.h>

#include <memory>

#include "cuda/device/buffer.h"
#include "cuda/device/device.h"
#include "cuda/scene/code_tables.h"
#include "cuda/scene/gaussian_view.h"
#include "runtime/base/workers.h"
#include "runtime/frame/scene.h"

namespace voyager::cuda {

class DevicePool;

class DeviceScene {
 public:
  // Resident; the device is in use().
  DeviceScene(const Device& device, const Scene& scene, Workers& workers);
  // Of a streamed scene: its pool's, which outlives this.
  explicit DeviceScene(const DevicePool& pool) : pool_(&pool) {}

  // For a frame: a pool may have another size in the next. Of a resident scene without what
  // DeviceParents adds; but with the nodes' codes, where every view reads their footprints.
  GaussianView view() const;
  // Stored bytes that projection reads of a Gaussian that is visible.
  uint32_t bytes_a_gaussian() const;

 private:
  void upload_codes(const Device& device, const Scene& scene);
  void upload_floats(const Scene& scene, Workers& workers);
  void upload_half_coefficients(const Scene& scene, Workers& workers);

  Buffer<float4> hulls_, shapes_;
  Buffer<__half> half_coefficients_;
  Buffer<float> coefficients_;
  Buffer<uint8_t> node_codes_;
  // Of a coded scene.
  Buffer<CodedHull> coded_hulls_;
  Buffer<ShapeRest> shape_codes_;
  Buffer<uint8_t> sh_rows_;
  Buffer<ShStepSizes> sh_steps_;
  Buffer<MeanGrid> mean_grids_;
  Buffer<RunBlock> group_blocks_;
  std::shared_ptr<const CodeTables> tables_;
  GaussianView view_{};
  const DevicePool* pool_ = nullptr;
};

}  // namespace voyager::cuda
