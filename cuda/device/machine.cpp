#include "cuda/device/machine.h"

#include <cuda_runtime_api.h>

#include <cstring>
#include <fstream>

#include "cuda/device/check.h"

namespace voyager::cuda {
namespace {

std::string version_text(int version) {
  return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

// That the driver supports; 0 where there is no driver.
int driver_version() {
  int version = 0;
  return cudaDriverGetVersion(&version) == cudaSuccess ? version : 0;
}

// "550.54.15"; "" where the kernel does not say.
std::string driver_release() {
  std::string release;
  std::ifstream("/sys/module/nvidia/version") >> release;
  return release;
}

BackendDevice describe(int ordinal) {
  cudaDeviceProp properties;
  check_start(cudaGetDeviceProperties(&properties, ordinal), "device properties");
  BackendDevice device;
  device.name = properties.name;
  std::memcpy(device.uuid.data(), properties.uuid.bytes, device.uuid.size());
  device.capability[0] = static_cast<uint32_t>(properties.major);
  device.capability[1] = static_cast<uint32_t>(properties.minor);
  device.memory_bytes = properties.totalGlobalMem;
  device.cuda_version = static_cast<uint32_t>(driver_version());
  device.driver = driver_release();
  device.missing = missing_from(properties);
  return device;
}

}  // namespace

void require_driver_and_device() {
  // A driver serves every run-time of its own major version.
  constexpr int kLeastDriver = CUDART_VERSION / 1000 * 1000;
  const int found = driver_version();
  const std::string expected = "expected one for CUDA " + version_text(kLeastDriver) + " or newer";
  if (found == 0)
    throw Error(ErrorCode::no_device,
                "CUDA: found no NVIDIA driver, " + expected +
                    ". Without an NVIDIA GPU this is as it should be; with one, install its "
                    "driver");
  if (found < kLeastDriver)
    throw Error(ErrorCode::no_device, "CUDA: found a driver for CUDA " + version_text(found) +
                                          ", " + expected + ": update the driver");
  int count = 0;
  check_start(cudaGetDeviceCount(&count), "devices");
}

std::string missing_from(const cudaDeviceProp& properties) {
  if (static_cast<uint32_t>(properties.major) >= kLeastComputeCapability) return "";
  return std::string(properties.name) + ": found compute capability " +
         std::to_string(properties.major) + "." + std::to_string(properties.minor) + ", expected " +
         std::to_string(kLeastComputeCapability) +
         ".0 or newer: it takes a newer GPU (Ampere or later), or the CPU";
}

std::vector<BackendDevice> list_devices() {
  require_driver_and_device();
  int count = 0;
  check_start(cudaGetDeviceCount(&count), "devices");
  std::vector<BackendDevice> devices;
  devices.reserve(static_cast<size_t>(count));
  for (int ordinal = 0; ordinal < count; ++ordinal) devices.push_back(describe(ordinal));
  return devices;
}

}  // namespace voyager::cuda
