#include "xr_validation.h"

#include <cstdio>
#include <cstdlib>

namespace host {

XrValidation::XrValidation()
    : messenger_(xr_struct<XrDebugUtilsMessengerCreateInfoEXT>(
          XR_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT)) {
  messenger_.messageSeverities = XR_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                                 XR_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  // Not GENERAL: there the loader talks about the machine.
  messenger_.messageTypes = XR_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                            XR_DEBUG_UTILS_MESSAGE_TYPE_CONFORMANCE_BIT_EXT;
  messenger_.userCallback = report;
  messenger_.userData = this;
  // The layer prints to standard output too, if it is not told otherwise.
  setenv("XR_CORE_VALIDATION_EXPORT_TYPE", "none", 0);
}

XrBool32 XrValidation::report(XrDebugUtilsMessageSeverityFlagsEXT, XrDebugUtilsMessageTypeFlagsEXT,
                              const XrDebugUtilsMessengerCallbackDataEXT* data, void* self) {
  ++static_cast<XrValidation*>(self)->messages_;
  std::fprintf(stderr, "validation: %s: %s: %s\n", data->functionName, data->messageId,
               data->message);
  return XR_FALSE;
}

}  // namespace host
