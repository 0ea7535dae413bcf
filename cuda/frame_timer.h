#pragma once
#include <cuda_runtime_api.h>

#include <vector>

namespace voyager::cuda {

// A stream, and events between the parts of its work.
class FrameTimer {
 public:
  explicit FrameTimer(size_t marks);
  ~FrameTimer();
  FrameTimer(const FrameTimer&) = delete;
  FrameTimer& operator=(const FrameTimer&) = delete;

  cudaStream_t stream() const { return stream_; }
  void mark(size_t index);
  // Until all that was launched is done.
  void wait() const;
  // Waits. Both marks must have been passed.
  double milliseconds(size_t from, size_t to) const;

 private:
  void release();

  cudaStream_t stream_ = nullptr;
  std::vector<cudaEvent_t> events_;
};

}  // namespace voyager::cuda
