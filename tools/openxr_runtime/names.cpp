#include <openxr/openxr_reflection.h>

#include "api.h"

namespace test_runtime {

#define TEST_RUNTIME_CASE(name, value) \
  case name:                           \
    return #name;

std::string name_of(XrResult result) {
  switch (result) { XR_LIST_ENUM_XrResult(TEST_RUNTIME_CASE) default : break; }
  return (result < 0 ? "XR_UNKNOWN_FAILURE_" : "XR_UNKNOWN_SUCCESS_") + std::to_string(result);
}

std::string name_of(XrStructureType type) {
  switch (type) { XR_LIST_ENUM_XrStructureType(TEST_RUNTIME_CASE) default : break; }
  return "XR_UNKNOWN_STRUCTURE_TYPE_" + std::to_string(type);
}

std::string name_of(XrSessionState state) {
  switch (state) { XR_LIST_ENUM_XrSessionState(TEST_RUNTIME_CASE) default : break; }
  return "XR_SESSION_STATE_" + std::to_string(state);
}

#undef TEST_RUNTIME_CASE

}  // namespace test_runtime
