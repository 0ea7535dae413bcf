#pragma once
#include <cuda_runtime_api.h>

#include "runtime/frame/scene_search.h"

namespace voyager::cuda {

// A stream and the events around a frame's kernels.
class FrameTimer {
 public:
  FrameTimer();
  ~FrameTimer();
  FrameTimer(const FrameTimer&) = delete;
  FrameTimer& operator=(const FrameTimer&) = delete;

  cudaStream_t stream() const { return stream_; }
  void begin();
  void middle();
  void end();
  void wait() const;
  // Waits; milliseconds from begin to middle, and from middle to end.
  SearchTimes times() const;

 private:
  void release();

  cudaStream_t stream_ = nullptr;
  cudaEvent_t events_[3] = {};
};

}  // namespace voyager::cuda
