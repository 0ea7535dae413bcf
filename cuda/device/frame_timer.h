#pragma once
#include <vector>

#include "cuda/device/stream.h"

namespace voyager::cuda {

// Events between the parts of a stream's work.
class FrameTimer {
 public:
  FrameTimer(const Stream& stream, size_t marks) : stream_(stream.get()), events_(marks) {}

  void mark(size_t index) { events_[index].record(stream_); }
  // Waits for the later mark, spinning: what takes a frame's times has waited for its report
  // before.
  double milliseconds(size_t from, size_t to) const {
    events_[to].wait();
    float elapsed = 0;
    check(cudaEventElapsedTime(&elapsed, events_[from].get(), events_[to].get()), "time");
    return static_cast<double>(elapsed);
  }

 private:
  cudaStream_t stream_;
  std::vector<Event> events_;
};

}  // namespace voyager::cuda
