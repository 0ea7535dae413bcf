#include "cuda/frame_limits.h"

namespace voyager::cuda {

void FrameLimits::fit(const FrameInput& frame) {
  const size_t pixels = size_t{frame.camera.width} * frame.camera.height;
  if (frame.limits.values == nullptr || values_.size() >= pixels) return;
  values_ = {};
  values_ = Buffer<float>(pixels);
}

DepthLimits FrameLimits::upload(const FrameInput& frame, cudaStream_t stream) const {
  const DepthLimits& host = frame.limits;
  if (host.values == nullptr) return {};
  const size_t row = frame.camera.width * sizeof(float);
  check(cudaMemcpy2DAsync(values_.data(), row, host.values, host.pitch, row, frame.camera.height,
                          cudaMemcpyHostToDevice, stream),
        "depth limits");
  return {values_.data(), row, host.encoding};
}

}  // namespace voyager::cuda
