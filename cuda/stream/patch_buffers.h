#pragma once
// LinkPatches on their way to a device.
#include <deque>

#include "cuda/device/mapped_memory.h"
#include "cuda/device/stream.h"
#include "cuda/stream/pool_launch.h"

namespace voyager::cuda {

// Made as many, and as large, as were on their way at once. Not thread-safe.
class PatchBuffers {
 public:
  // A copy of the patch, until the device has passed what read_by() says. file: that its
  // chunks are of.
  PoolPatch put(const LinkPatch& patch, const SceneFile& file);
  // What reads the patch that was put last has been launched on the stream.
  void read_by(cudaStream_t stream) const { last_->read.record(stream); }

 private:
  struct Buffer {
    std::unique_ptr<MappedMemory> memory;
    Event read{cudaEventDisableTiming};
  };

  MappedMemory& free_memory(size_t bytes);

  std::deque<Buffer> buffers_;
  Buffer* last_ = nullptr;
};

}  // namespace voyager::cuda
