#include "cuda/device.h"

#include <cuda.h>
#include <cuda_runtime_api.h>

#include <cstring>

#include "cuda/check.h"
#include "runtime/base/error.h"

namespace voyager::cuda {

namespace {

constexpr int kLeastCapability = 8;  // the oldest that cmake/cuda.cmake compiles for

}  // namespace

Device::Device(int ordinal, unsigned multiprocessors) : ordinal_(ordinal) {
  cudaDeviceProp properties;
  check(cudaGetDeviceProperties(&properties, ordinal), "looking for a device with a driver for it");
  if (properties.major < kLeastCapability)
    throw Error(ErrorCode::no_device,
                std::string("CUDA: ") + properties.name + ": found compute capability " +
                    std::to_string(properties.major) + "." + std::to_string(properties.minor) +
                    ", expected " + std::to_string(kLeastCapability) + ".0 or newer");
  check(cudaSetDevice(ordinal), "device");
  name_ = properties.name;
  std::memcpy(uuid_.data(), properties.uuid.bytes, uuid_.size());
  multiprocessors_ = static_cast<unsigned>(properties.multiProcessorCount);
  if (multiprocessors != 0 && multiprocessors < multiprocessors_)
    make_green_context(multiprocessors);
}

#if CUDART_VERSION >= 12050
namespace {

constexpr unsigned kGreenContextVersion = 12040;

// The driver's functions by name: the module needs no libcuda to be linked or loaded.
template <class Function>
Function driver_function(const char* name, unsigned version = kGreenContextVersion) {
  void* address = nullptr;
  cudaDriverEntryPointQueryResult found;
  check(cudaGetDriverEntryPointByVersion(name, &address, version, cudaEnableDefault, &found), name);
  if (found != cudaDriverEntryPointSuccess)
    throw Error(ErrorCode::unsupported, std::string("CUDA: ") + name +
                                            ": found a driver without it, expected 12.4 or newer");
  return reinterpret_cast<Function>(address);
}

void check_driver(CUresult status, const char* what) {
  if (status != CUDA_SUCCESS)
    throw Error(ErrorCode::internal,
                std::string("CUDA: ") + what + ": driver error " + std::to_string(status));
}

}  // namespace

void Device::make_green_context(unsigned multiprocessors) {
  check(cudaFree(nullptr), "context");  // the primary context, which green ones divide
  const auto get_resource =
      driver_function<CUresult (*)(CUdevice, CUdevResource*, CUdevResourceType)>(
          "cuDeviceGetDevResource");
  const auto split =
      driver_function<CUresult (*)(CUdevResource*, unsigned*, const CUdevResource*, CUdevResource*,
                                   unsigned, unsigned)>("cuDevSmResourceSplitByCount");
  const auto describe = driver_function<CUresult (*)(CUdevResourceDesc*, CUdevResource*, unsigned)>(
      "cuDevResourceGenerateDesc");
  const auto create =
      driver_function<CUresult (*)(CUgreenCtx*, CUdevResourceDesc, CUdevice, unsigned)>(
          "cuGreenCtxCreate");
  const auto to_context =
      driver_function<CUresult (*)(CUcontext*, CUgreenCtx)>("cuCtxFromGreenCtx");
  CUdevResource all{}, part{}, rest{};
  check_driver(get_resource(ordinal_, &all, CU_DEV_RESOURCE_TYPE_SM), "multiprocessors");
  unsigned groups = 1;
  check_driver(split(&part, &groups, &all, &rest, 0, multiprocessors), "a part of them");
  CUdevResourceDesc description = nullptr;
  check_driver(describe(&description, &part, 1), "description of a part");
  CUgreenCtx green = nullptr;
  check_driver(create(&green, description, ordinal_, CU_GREEN_CTX_DEFAULT_STREAM), "green context");
  green_ = green;
  CUcontext context = nullptr;
  check_driver(to_context(&context, green), "green context");
  context_ = context;
  multiprocessors_ = part.sm.smCount;
}

Device::~Device() {
  if (green_ == nullptr) return;
  cudaSetDevice(ordinal_);
  try {
    driver_function<CUresult (*)(CUgreenCtx)>("cuGreenCtxDestroy")(static_cast<CUgreenCtx>(green_));
  } catch (const Error&) {
    return;  // it was there when the context was made
  }
}

void Device::use() const {
  if (context_ == nullptr) return check(cudaSetDevice(ordinal_), "device");
  static const auto set_current = driver_function<CUresult (*)(CUcontext)>("cuCtxSetCurrent", 4000);
  check_driver(set_current(static_cast<CUcontext>(context_)), "green context");
}
#else
void Device::make_green_context(unsigned) {
  throw Error(
      ErrorCode::unsupported,
      "a part of the multiprocessors: found a build with CUDA before 12.5, expected a newer one");
}

Device::~Device() = default;

void Device::use() const {
  check(cudaSetDevice(ordinal_), "device");
}
#endif

DeviceRates Device::rates() const {
  const auto attribute = [&](cudaDeviceAttr name) {
    int value = 0;
    check(cudaDeviceGetAttribute(&value, name, ordinal_), "device attribute");
    return static_cast<double>(value);
  };
  constexpr double kLanes = 128, kHertz = 1e3;  // clocks are in kHz
  const double memory_hertz = kHertz * attribute(cudaDevAttrMemoryClockRate);
  return {kLanes * multiprocessors_ * kHertz * attribute(cudaDevAttrClockRate),
          2 * memory_hertz * attribute(cudaDevAttrGlobalMemoryBusWidth) / 8};  // two a clock
}

void Device::use_quietly() const noexcept {
  try {
    use();
  } catch (const Error&) {
    return;
  }
}

}  // namespace voyager::cuda
