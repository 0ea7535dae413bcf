#pragma once
#include <cuda_runtime_api.h>

#include <cstddef>
#include <utility>

#include "cuda/device/check.h"
#include "runtime/base/error.h"

namespace voyager::cuda {

// Flags of an event that a host waits for: it sleeps meanwhile. Without them CUDA spins, and a
// headset has no core to spin on.
inline constexpr unsigned kWaitedFor = cudaEventDisableTiming | cudaEventBlockingSync;

// A point in a stream's work.
class Event {
 public:
  explicit Event(unsigned flags = cudaEventDefault) {
    check(cudaEventCreateWithFlags(&event_, flags), "event");
  }
  Event(Event&& other) noexcept : event_(std::exchange(other.event_, nullptr)) {}
  Event& operator=(Event&&) = delete;
  ~Event() {
    if (event_ != nullptr) cudaEventDestroy(event_);
  }

  cudaEvent_t get() const { return event_; }
  void record(cudaStream_t stream) const { check(cudaEventRecord(event_, stream), "event"); }
  void wait() const { check(cudaEventSynchronize(event_), "a frame"); }
  // Passed, or never recorded.
  bool passed() const {
    const cudaError_t status = cudaEventQuery(event_);
    if (status != cudaErrorNotReady) check(status, "a frame");
    return status == cudaSuccess;
  }

 private:
  cudaEvent_t event_ = nullptr;
};

// Until all work on the stream has ended; asleep, while cudaStreamSynchronize() would spin.
inline void wait_for(cudaStream_t stream) {
  const Event ended(kWaitedFor);
  ended.record(stream);
  ended.wait();
}

// A stream with an owner, which waits for its work before it goes.
class Stream {
 public:
  Stream() { check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "stream"); }
  ~Stream() {
    cudaStreamSynchronize(stream_);
    cudaStreamDestroy(stream_);
  }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  cudaStream_t get() const { return stream_; }
  // As wait_for(). The current context is the stream's.
  void wait() const { wait_for(stream_); }
  // For destructors: what fails has failed before.
  void wait_quietly() const noexcept {
    try {
      wait();
    } catch (const Error&) {
      return;
    }
  }

 private:
  cudaStream_t stream_ = nullptr;
};

// The host's memory that a stream copies to.
class PinnedMemory {
 public:
  explicit PinnedMemory(size_t bytes) : bytes_(bytes) {
    check(cudaMallocHost(&data_, bytes), "pinned memory");
  }
  ~PinnedMemory() { cudaFreeHost(data_); }
  PinnedMemory(const PinnedMemory&) = delete;
  PinnedMemory& operator=(const PinnedMemory&) = delete;

  unsigned char* data() const { return static_cast<unsigned char*>(data_); }
  size_t bytes() const { return bytes_; }

 private:
  size_t bytes_;
  void* data_ = nullptr;
};

}  // namespace voyager::cuda
