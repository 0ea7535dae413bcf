#include "cuda/frame/frame_limits.h"

#include <cstring>

namespace voyager::cuda {

namespace {

size_t pixels_of(const FrameEye& eye) {
  return size_t{eye.camera.width} * eye.camera.height;
}

}  // namespace

bool FrameLimits::fits(const FrameEye& eye) const {
  return eye.limits.values == nullptr || values_.size() >= pixels_of(eye);
}

void FrameLimits::fit(const FrameEye& eye) {
  if (fits(eye)) return;
  values_ = {};
  staged_.reset();
  staged_.emplace(pixels_of(eye) * sizeof(float));
  values_ = Buffer<float>(pixels_of(eye));
}

DepthLimits FrameLimits::upload(const FrameEye& eye, cudaStream_t stream) const {
  const DepthLimits& host = eye.limits;
  if (host.values == nullptr) return {};
  const size_t row = eye.camera.width * sizeof(float);
  for (size_t y = 0; y < eye.camera.height; ++y)
    std::memcpy(staged_->data() + y * row,
                reinterpret_cast<const unsigned char*>(host.values) + y * host.pitch, row);
  check(cudaMemcpyAsync(values_.data(), staged_->data(), row * eye.camera.height,
                        cudaMemcpyHostToDevice, stream),
        "depth limits");
  return {values_.data(), row, host.encoding};
}

}  // namespace voyager::cuda
