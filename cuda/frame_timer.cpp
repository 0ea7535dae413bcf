#include "cuda/frame_timer.h"

#include "cuda/check.h"
#include "cuda/head_start.h"

namespace voyager::cuda {

FrameTimer::FrameTimer() {
  try {
    check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "stream");
    for (cudaEvent_t& event : events_) check(cudaEventCreate(&event), "event");
  } catch (...) {
    release();
    throw;
  }
}

FrameTimer::~FrameTimer() {
  release();
}

void FrameTimer::release() {
  if (stream_ != nullptr) cudaStreamSynchronize(stream_);
  for (cudaEvent_t event : events_)
    if (event != nullptr) cudaEventDestroy(event);
  if (stream_ != nullptr) cudaStreamDestroy(stream_);
}

void FrameTimer::begin() {
  give_head_start(stream_);
  check(cudaEventRecord(events_[0], stream_), "event");
}
void FrameTimer::middle() {
  check(cudaEventRecord(events_[1], stream_), "event");
}
void FrameTimer::end() {
  check(cudaEventRecord(events_[2], stream_), "event");
}
void FrameTimer::wait() const {
  check(cudaStreamSynchronize(stream_), "a frame's search");
}

SearchTimes FrameTimer::times() const {
  wait();
  float search = 0, weights = 0;
  check(cudaEventElapsedTime(&search, events_[0], events_[1]), "time");
  check(cudaEventElapsedTime(&weights, events_[1], events_[2]), "time");
  return {search, weights};
}

}  // namespace voyager::cuda
