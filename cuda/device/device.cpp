#include "cuda/device/device.h"

#include <cuda.h>
#include <cuda_runtime_api.h>

#include <cstring>

#include "cuda/device/check.h"
#include "cuda/device/device_rates.h"
#include "cuda/device/machine.h"
#include "cuda/scene/code_tables.h"
#include "runtime/base/error.h"

namespace voyager::cuda {

Device::Device(int ordinal, unsigned multiprocessors) : ordinal_(ordinal) {
  cudaDeviceProp properties;
  check_start(cudaGetDeviceProperties(&properties, ordinal), "device properties");
  if (const std::string missing = missing_from(properties); !missing.empty())
    throw Error(ErrorCode::no_device, "CUDA: " + missing);
  check_start(cudaSetDevice(ordinal), properties.name);
  name_ = properties.name;
  std::memcpy(uuid_.data(), properties.uuid.bytes, uuid_.size());
  multiprocessors_ = static_cast<unsigned>(properties.multiProcessorCount);
  memory_bytes_ = properties.totalGlobalMem;
  if (multiprocessors != 0 && multiprocessors < multiprocessors_)
    make_green_context(multiprocessors);
}

std::shared_ptr<const CodeTables> Device::code_tables() const {
  const std::lock_guard lock(tables_mutex_);
  std::shared_ptr<const CodeTables> tables = tables_.lock();
  if (tables == nullptr) tables_ = tables = std::make_shared<const CodeTables>();
  return tables;
}

namespace {

// The driver's functions by name: the module needs no libcuda to be linked or loaded.
template <class Function>
Function driver_function(const char* name, [[maybe_unused]] unsigned version) {
  void* address = nullptr;
  cudaDriverEntryPointQueryResult found;
#if CUDART_VERSION >= 12050
  check(cudaGetDriverEntryPointByVersion(name, &address, version, cudaEnableDefault, &found), name);
#else
  check(cudaGetDriverEntryPoint(name, &address, cudaEnableDefault, &found), name);
#endif
  if (found != cudaDriverEntryPointSuccess)
    throw Error(ErrorCode::unsupported,
                std::string("CUDA: ") + name + ": found a driver without it, expected a newer one");
  return reinterpret_cast<Function>(address);
}

void check_driver(CUresult status, const char* what) {
  if (status != CUDA_SUCCESS)
    throw Error(ErrorCode::internal,
                std::string("CUDA: ") + what + ": driver error " + std::to_string(status));
}

void set_current(CUcontext context) {
  static const auto set = driver_function<CUresult (*)(CUcontext)>("cuCtxSetCurrent", 4000);
  check_driver(set(context), "context");
}

}  // namespace

std::shared_ptr<void> keep_context() {
  static const auto get = driver_function<CUresult (*)(CUcontext*)>("cuCtxGetCurrent", 4000);
  CUcontext current = nullptr;
  check_driver(get(&current), "context");
  const auto set_back = [](void* context) {
    try {
      set_current(static_cast<CUcontext>(context));
    } catch (const Error&) {
      return;  // the host destroyed it meanwhile
    }
  };
  return {static_cast<void*>(current), set_back};
}

#if CUDART_VERSION >= 12050
void Device::make_green_context(unsigned multiprocessors) {
  check(cudaFree(nullptr), "context");  // the primary context, which green ones divide
  constexpr unsigned kVersion = 12040;
  const auto get_resource =
      driver_function<CUresult (*)(CUdevice, CUdevResource*, CUdevResourceType)>(
          "cuDeviceGetDevResource", kVersion);
  const auto split =
      driver_function<CUresult (*)(CUdevResource*, unsigned*, const CUdevResource*, CUdevResource*,
                                   unsigned, unsigned)>("cuDevSmResourceSplitByCount", kVersion);
  const auto describe = driver_function<CUresult (*)(CUdevResourceDesc*, CUdevResource*, unsigned)>(
      "cuDevResourceGenerateDesc", kVersion);
  const auto create =
      driver_function<CUresult (*)(CUgreenCtx*, CUdevResourceDesc, CUdevice, unsigned)>(
          "cuGreenCtxCreate", kVersion);
  const auto to_context =
      driver_function<CUresult (*)(CUcontext*, CUgreenCtx)>("cuCtxFromGreenCtx", kVersion);
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
    driver_function<CUresult (*)(CUgreenCtx)>("cuGreenCtxDestroy",
                                              12040)(static_cast<CUgreenCtx>(green_));
  } catch (const Error&) {
    return;  // it was there when the context was made
  }
}

void Device::use() const {
  if (context_ == nullptr) return check(cudaSetDevice(ordinal_), "device");
  set_current(static_cast<CUcontext>(context_));
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

ExternalSupport Device::external_support() const {
  int timelines = 0;
  check(cudaDeviceGetAttribute(&timelines, cudaDevAttrTimelineSemaphoreInteropSupported, ordinal_),
        "device attribute");
  return {true, timelines != 0, true};
}

void Device::use_whole() const {
  check(cudaSetDevice(ordinal_), "device");
}

DeviceRates Device::rates() const {
  return rates_of(multiprocessors_, [&](ClockQuery query) -> std::optional<int> {
    const cudaDeviceAttr name = query == ClockQuery::memory_khz ? cudaDevAttrMemoryClockRate
                                : query == ClockQuery::memory_bus_bits
                                    ? cudaDevAttrGlobalMemoryBusWidth
                                    : cudaDevAttrClockRate;
    int value = 0;
    if (cudaDeviceGetAttribute(&value, name, ordinal_) == cudaSuccess) return value;
    cudaGetLastError();
    return std::nullopt;
  });
}

void Device::use_quietly() const noexcept {
  try {
    use();
  } catch (const Error&) {
    return;
  }
}

}  // namespace voyager::cuda
