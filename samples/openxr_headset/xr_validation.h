#pragma once
// OpenXR's core validation layer: its messages go to standard error, and are counted.
#include <atomic>
#include <cstdint>

#include "xr.h"

namespace host {

inline constexpr const char* kXrValidationLayer = "XR_APILAYER_LUNARG_core_validation";

class XrValidation {
 public:
  XrValidation();
  // To be chained to XrInstanceCreateInfo.
  const void* instance_chain() const { return &messenger_; }
  uint64_t messages() const { return messages_; }

 private:
  static XRAPI_ATTR XrBool32 XRAPI_CALL report(XrDebugUtilsMessageSeverityFlagsEXT severity,
                                               XrDebugUtilsMessageTypeFlagsEXT types,
                                               const XrDebugUtilsMessengerCallbackDataEXT* data,
                                               void* self);

  std::atomic<uint64_t> messages_ = 0;
  XrDebugUtilsMessengerCreateInfoEXT messenger_;
};

}  // namespace host
