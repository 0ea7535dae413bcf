#pragma once
// Tests that need a CUDA device.
#include <cuda_runtime_api.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "cuda/cuda_backend.h"
#include "cuda/device/check.h"
#include "cuda/device/device.h"
#include "tests/support/needs.h"

namespace voyager::test {

class DeviceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    int devices = 0;
    const cudaError_t status = cudaGetDeviceCount(&devices);
    if (status != cudaSuccess || devices == 0)
      VOYAGER_SKIP_WITHOUT(CUDA, std::string("no CUDA device: ") + cudaGetErrorString(status));
  }

  static std::shared_ptr<const cuda::Device> device(unsigned multiprocessors = 0) {
    return std::make_shared<cuda::Device>(0, multiprocessors);
  }

  static std::unique_ptr<Backend> create_backend(unsigned multiprocessors = 0) {
    return cuda::create_cuda_backend({0, multiprocessors, nullptr});
  }

  // Of the device's memory.
  static size_t free_bytes() {
    size_t free = 0, all = 0;
    cuda::check(cudaMemGetInfo(&free, &all), "memory");
    return free;
  }
};

}  // namespace voyager::test
