#include "cuda/frame_timer.h"

#include "cuda/check.h"

namespace voyager::cuda {

FrameTimer::FrameTimer(size_t marks) : events_(marks, nullptr) {
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

void FrameTimer::mark(size_t index) {
  check(cudaEventRecord(events_[index], stream_), "event");
}
void FrameTimer::wait() const {
  check(cudaStreamSynchronize(stream_), "a frame");
}

double FrameTimer::milliseconds(size_t from, size_t to) const {
  wait();
  float elapsed = 0;
  check(cudaEventElapsedTime(&elapsed, events_[from], events_[to]), "time");
  return elapsed;
}

}  // namespace voyager::cuda
