#pragma once
// Device memory with an owner.
#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "cuda/device/check.h"

namespace voyager::cuda {

// Bytes of all live allocations. Tests of omissions count these, since other processes also change
// a device's free memory.
inline std::atomic<size_t> buffer_bytes{0};

class Allocation {
 public:
  explicit Allocation(size_t bytes) : bytes_(bytes) {
    check(cudaMalloc(&data_, bytes), "allocation");
    buffer_bytes += bytes_;
  }
  Allocation(const Allocation&) = delete;
  Allocation& operator=(const Allocation&) = delete;
  ~Allocation() {
    buffer_bytes -= bytes_;  // first: cudaFree() waits for the device
    cudaFree(data_);
  }

  unsigned char* data() const { return static_cast<unsigned char*>(data_); }

 private:
  void* data_ = nullptr;
  size_t bytes_;
};

template <class T>
class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(size_t count) : count_(count) {
    if (count == 0) return;
    memory_ = std::make_shared<const Allocation>(count * sizeof(T));
    data_ = reinterpret_cast<T*>(memory_->data());
  }
  // `count` elements of a shared allocation, from byte `at` on.
  Buffer(std::shared_ptr<const Allocation> memory, size_t at, size_t count) : count_(count) {
    if (count == 0) return;
    memory_ = std::move(memory);
    data_ = reinterpret_cast<T*>(memory_->data() + at);
  }
  Buffer(Buffer&& other) noexcept
      : memory_(std::move(other.memory_)),
        data_(std::exchange(other.data_, nullptr)),
        count_(std::exchange(other.count_, 0)) {}
  Buffer& operator=(Buffer&& other) noexcept {
    std::swap(memory_, other.memory_);
    std::swap(data_, other.data_);
    std::swap(count_, other.count_);
    return *this;
  }

  T* data() const { return data_; }
  size_t size() const { return count_; }
  size_t bytes() const { return count_ * sizeof(T); }

 private:
  std::shared_ptr<const Allocation> memory_;
  T* data_ = nullptr;
  size_t count_ = 0;
};

template <class T>
struct ToAllocate {
  Buffer<T>& buffer;
  size_t count;
};
template <class T>
ToAllocate(Buffer<T>&, size_t) -> ToAllocate<T>;

inline constexpr size_t kAllocationAlignment = 256;  // as cudaMalloc()'s

// Arrays that live and go together, in one allocation: a device gives memory in steps of 2 MB. Each
// begins at a multiple of kAllocationAlignment.
template <class... T>
void allocate_together(const ToAllocate<T>&... arrays) {
  size_t bytes = 0;
  const auto place = [&](size_t of) {
    const size_t steps = (of + kAllocationAlignment - 1) / kAllocationAlignment;
    return std::exchange(bytes, bytes + steps * kAllocationAlignment);
  };
  const size_t places[] = {place(arrays.count * sizeof(T))...};
  std::shared_ptr<const Allocation> memory;
  if (bytes != 0) memory = std::make_shared<const Allocation>(bytes);
  const size_t* next = places;
  ((arrays.buffer = Buffer<T>(memory, *next++, arrays.count)), ...);
}

// Copies and fills go through the default stream, which the streams of frames do not
// wait for: so these wait for it, and are complete when they return. into: as long as the values.
template <class T>
void upload(std::span<const T> values, const Buffer<T>& into) {
  if (values.empty()) return;
  check(cudaMemcpy(into.data(), values.data(), values.size_bytes(), cudaMemcpyHostToDevice),
        "upload");
  check(cudaStreamSynchronize(nullptr), "upload");
}
template <class T>
Buffer<T> upload(std::span<const T> values) {
  Buffer<T> buffer(values.size());
  upload(values, buffer);
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
