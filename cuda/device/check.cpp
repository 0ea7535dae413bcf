#include "cuda/device/check.h"

#include "runtime/base/error.h"

namespace voyager::cuda {
namespace {

ErrorCode code_of(cudaError_t status) {
  switch (status) {
    case cudaErrorMemoryAllocation:
      return ErrorCode::over_budget;
    case cudaErrorNoDevice:
    case cudaErrorInsufficientDriver:
    case cudaErrorDevicesUnavailable:
    case cudaErrorNoKernelImageForDevice:
    case cudaErrorInitializationError:
    case cudaErrorSystemNotReady:
    case cudaErrorSystemDriverMismatch:
    case cudaErrorCompatNotSupportedOnDevice:
      return ErrorCode::no_device;
    case cudaErrorIllegalAddress:
    case cudaErrorLaunchFailure:
    case cudaErrorLaunchTimeout:
    case cudaErrorHardwareStackError:
    case cudaErrorECCUncorrectable:
    case cudaErrorContextIsDestroyed:
    case cudaErrorMisalignedAddress:
    case cudaErrorInvalidAddressSpace:
    case cudaErrorIllegalInstruction:
    case cudaErrorInvalidPc:
    case cudaErrorAssert:
    case cudaErrorUnknown:
      return ErrorCode::device_lost;
    default:
      return ErrorCode::internal;
  }
}

const char* advice(cudaError_t status) {
  switch (status) {
    case cudaErrorMemoryAllocation:
      return "; end other programs that use the GPU (nvidia-smi lists them), or draw on the CPU";
    case cudaErrorDevicesUnavailable:
      return "; another process has the GPU for itself: end it, or ask the administrator to allow "
             "several (nvidia-smi shows the compute mode)";
    case cudaErrorNoDevice:
      return "; nvidia-smi shows which GPUs the driver sees, and CUDA_VISIBLE_DEVICES may hide "
             "them";
    case cudaErrorSystemDriverMismatch:
      return "; the driver was updated while it was in use: restart the machine";
    default:
      return "; nvidia-smi shows whether the driver works";
  }
}

}  // namespace

void check_start(cudaError_t status, const char* what) {
  if (status == cudaSuccess) return;
  cudaGetLastError();
  throw Error(code_of(status),
              std::string("CUDA: ") + what + ": " + cudaGetErrorString(status) + advice(status));
}

void check(cudaError_t status, const char* what) {
  if (status == cudaSuccess) return;
  cudaGetLastError();  // an error that is reported here must not be found again by a later call
  throw Error(code_of(status), std::string("CUDA: ") + what + ": " + cudaGetErrorString(status));
}

}  // namespace voyager::cuda
