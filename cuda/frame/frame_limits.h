#pragma once
// An eye's depth limits on their way from the host.
#include <cuda_runtime_api.h>

#include <optional>

#include "cuda/device/buffer.h"
#include "cuda/device/stream.h"
#include "runtime/frame/backend.h"

namespace voyager::cuda {

class FrameLimits {
 public:
  // Whether there is room for them, if there are any.
  bool fits(const FrameEye& eye) const;
  // Makes room for them. Nothing on the device uses the buffer. Throws Error.
  void fit(const FrameEye& eye);
  // Whether some frame had them.
  bool any() const { return values_.size() != 0; }
  // As kernels on the stream take them; there is room, and the device has read those of the frame
  // before. The host's own memory is read before this returns.
  DepthLimits upload(const FrameEye& eye, cudaStream_t stream) const;

 private:
  Buffer<float> values_;  // as the host encodes them, tightly packed
  // On their way: a copy out of pageable memory would wait for all that the stream has to do.
  std::optional<PinnedMemory> staged_;
};

}  // namespace voyager::cuda
