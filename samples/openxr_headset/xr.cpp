#include "xr.h"

#include <openxr/openxr_reflection.h>

namespace host {

std::string result_name(XrResult result) {
#define HOST_XR_RESULT(name, value) \
  case name:                        \
    return #name;
  switch (result) {
    XR_LIST_ENUM_XrResult(HOST_XR_RESULT) default : return "XrResult " + std::to_string(result);
  }
#undef HOST_XR_RESULT
}

XrResult check(XrResult result, const char* call) {
  if (XR_SUCCEEDED(result)) return result;
  const std::string message = std::string(call) + ": " + result_name(result);
  switch (result) {
    case XR_ERROR_SESSION_LOST:
      throw Lost(Lost::session, message);
    case XR_ERROR_INSTANCE_LOST:
    case XR_ERROR_RUNTIME_UNAVAILABLE:
      throw Lost(Lost::instance, message);
    default:
      throw Failure(kMachine, message);
  }
}

}  // namespace host
