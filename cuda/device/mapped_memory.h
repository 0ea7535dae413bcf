#pragma once
// Memory of the host that kernels read where it lies: across the bus, or, where host and
// device share their memory, without a copy.
#include <cuda_runtime_api.h>

#include "cuda/device/check.h"

namespace voyager::cuda {

class MappedMemory {
 public:
  explicit MappedMemory(size_t bytes) : bytes_(bytes) {
    check(cudaHostAlloc(&host_, bytes, cudaHostAllocPortable | cudaHostAllocMapped),
          "mapped memory");
    const cudaError_t status = cudaHostGetDevicePointer(&device_, host_, 0);
    if (status == cudaSuccess) return;
    cudaFreeHost(host_);
    check(status, "mapped memory");
  }
  ~MappedMemory() { cudaFreeHost(host_); }
  MappedMemory(const MappedMemory&) = delete;
  MappedMemory& operator=(const MappedMemory&) = delete;

  unsigned char* host() const { return static_cast<unsigned char*>(host_); }
  // As kernels address it.
  const unsigned char* device() const { return static_cast<const unsigned char*>(device_); }
  size_t bytes() const { return bytes_; }

 private:
  size_t bytes_;
  void* host_ = nullptr;
  void* device_ = nullptr;
};

}  // namespace voyager::cuda
