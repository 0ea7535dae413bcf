#pragma once
// A frame's depth limits on their way from the host.
#include <cuda_runtime_api.h>

#include "cuda/buffer.h"
#include "runtime/frame/backend.h"

namespace voyager::cuda {

class FrameLimits {
 public:
  // Makes room for the frame's, if it has any. May allocate.
  void fit(const FrameInput& frame);
  // As kernels on the stream take them; there is room.
  DepthLimits upload(const FrameInput& frame, cudaStream_t stream) const;

 private:
  Buffer<float> values_;  // as the host encodes them, tightly packed
};

}  // namespace voyager::cuda
