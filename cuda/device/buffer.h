#pragma once
// Device memory with an owner.
#include <atomic>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "cuda/device/check.h"

namespace voyager::cuda {

// Of all buffers that are there: what tests of omissions count, since a device's free memory is
// other processes', too.
inline std::atomic<size_t> buffer_bytes{0};

template <class T>
class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(size_t count) : count_(count) {
    if (count == 0) return;
    check(cudaMalloc(&data_, count * sizeof(T)), "allocation");
    buffer_bytes += bytes();
  }
  Buffer(Buffer&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), count_(std::exchange(other.count_, 0)) {}
  Buffer& operator=(Buffer&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(count_, other.count_);
    return *this;
  }
  ~Buffer() {
    if (data_ == nullptr) return;
    buffer_bytes -= bytes();  // first: cudaFree() waits for the device
    cudaFree(data_);
  }

  T* data() const { return static_cast<T*>(data_); }
  size_t size() const { return count_; }
  size_t bytes() const { return count_ * sizeof(T); }

 private:
  void* data_ = nullptr;
  size_t count_ = 0;
};

// Copies and fills go through the default stream, which the streams of frames do not
// wait for: so these wait for it, and are complete when they return.
template <class T>
Buffer<T> upload(std::span<const T> values) {
  Buffer<T> buffer(values.size());
  if (values.empty()) return buffer;
  check(cudaMemcpy(buffer.data(), values.data(), values.size_bytes(), cudaMemcpyHostToDevice),
        "upload");
  check(cudaStreamSynchronize(nullptr), "upload");
  return buffer;
}

// Of what streams write, after they are done.
template <class T>
std::vector<T> download(const T* from, size_t count) {
  std::vector<T> values(count);
  if (count != 0)
    check(cudaMemcpy(values.data(), from, count * sizeof(T), cudaMemcpyDeviceToHost), "download");
  return values;
}
template <class T>
std::vector<T> download(const Buffer<T>& buffer) {
  return download(buffer.data(), buffer.size());
}

template <class T>
void fill(const Buffer<T>& buffer, int byte) {
  if (buffer.size() == 0) return;
  check(cudaMemset(buffer.data(), byte, buffer.bytes()), "initial state");
  check(cudaStreamSynchronize(nullptr), "initial state");
}

}  // namespace voyager::cuda
