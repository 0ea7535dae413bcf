#pragma once
// What the OpenXR loader and a runtime say to each other first (loader specification, interface
// version 1; the distribution packages no header of it).
#include <cstddef>
#include <cstdint>

#include "api.h"

namespace test_runtime {

inline constexpr uint32_t kLoaderInfo = 1, kRuntimeRequest = 3;  // structType
inline constexpr uint32_t kStructVersion = 1, kInterfaceVersion = 1;

struct NegotiateLoaderInfo {
  uint32_t struct_type;
  uint32_t struct_version;
  size_t struct_size;
  uint32_t min_interface_version;
  uint32_t max_interface_version;
  XrVersion min_api_version;
  XrVersion max_api_version;
};

struct NegotiateRuntimeRequest {
  uint32_t struct_type;
  uint32_t struct_version;
  size_t struct_size;
  uint32_t runtime_interface_version;  // from here on filled by the runtime
  XrVersion runtime_api_version;
  PFN_xrGetInstanceProcAddr get_instance_proc_addr;
};

}  // namespace test_runtime
