#include "cuda/frame_limits.h"

namespace voyager::cuda {

void FrameLimits::fit(const FrameEye& eye) {
  const size_t pixels = size_t{eye.camera.width} * eye.camera.height;
  if (eye.limits.values == nullptr || values_.size() >= pixels) return;
  values_ = {};
  values_ = Buffer<float>(pixels);
}

DepthLimits FrameLimits::upload(const FrameEye& eye, cudaStream_t stream) const {
  const DepthLimits& host = eye.limits;
  if (host.values == nullptr) return {};
  const size_t row = eye.camera.width * sizeof(float);
  check(cudaMemcpy2DAsync(values_.data(), row, host.values, host.pitch, row, eye.camera.height,
                          cudaMemcpyHostToDevice, stream),
        "depth limits");
  return {values_.data(), row, host.encoding};
}

}  // namespace voyager::cuda
