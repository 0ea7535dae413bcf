#include "loader.h"

using namespace test_runtime;

extern "C" __attribute__((visibility("default"))) XrResult XRAPI_CALL
xrNegotiateLoaderRuntimeInterface(const NegotiateLoaderInfo* loader,
                                  NegotiateRuntimeRequest* runtime) {
  const bool understood =
      loader && runtime && loader->struct_type == kLoaderInfo &&
      loader->struct_version == kStructVersion && loader->struct_size == sizeof *loader &&
      runtime->struct_type == kRuntimeRequest && runtime->struct_version == kStructVersion &&
      runtime->struct_size == sizeof *runtime;
  if (!understood || loader->min_interface_version > kInterfaceVersion ||
      loader->max_interface_version < kInterfaceVersion ||
      XR_VERSION_MAJOR(loader->min_api_version) > 1 ||
      XR_VERSION_MAJOR(loader->max_api_version) < 1)
    return XR_ERROR_INITIALIZATION_FAILED;
  runtime->runtime_interface_version = kInterfaceVersion;
  runtime->runtime_api_version = XR_CURRENT_API_VERSION;
  runtime->get_instance_proc_addr = &xrGetInstanceProcAddr;
  return XR_SUCCESS;
}
