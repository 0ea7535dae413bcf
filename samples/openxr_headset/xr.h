#pragma once
// Calls to the OpenXR runtime: their results, and owners of its handles.
#define XR_USE_GRAPHICS_API_VULKAN
#include <vulkan/vulkan.h>
// after Vulkan
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "failure.h"

namespace host {

// Thrown where the session or the instance is no more: the program makes another.
class Lost : public std::runtime_error {
 public:
  enum Kind { session, instance };
  Lost(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

// "XR_ERROR_..."; its number where this header does not know it.
std::string result_name(XrResult result);

// Passes a success on, qualified ones included. Throws Lost, else Failure(kMachine).
XrResult check(XrResult result, const char* call);

// A struct whose type is set and whose rest is zero.
template <class T>
T xr_struct(XrStructureType type) {
  T value = {};
  value.type = type;
  return value;
}

// What a call lists, asked for twice: how many, then which. Asked again where there came to be
// more in between.
template <class T, class Call>
std::vector<T> xr_list(const char* name, const T& empty, const Call& call) {
  for (;;) {
    uint32_t count = 0;
    check(call(0, &count, nullptr), name);
    std::vector<T> items(count, empty);
    if (count == 0) return items;
    const XrResult result = call(count, &count, items.data());
    if (result == XR_ERROR_SIZE_INSUFFICIENT) continue;
    check(result, name);
    items.resize(count);
    return items;
  }
}

// Destroyed with its owner.
template <class T, XrResult(XRAPI_PTR* destroy)(T)>
class XrUnique {
 public:
  XrUnique() = default;
  explicit XrUnique(T object) : object_(object) {}
  XrUnique(XrUnique&& other) noexcept : object_(std::exchange(other.object_, T{XR_NULL_HANDLE})) {}
  XrUnique& operator=(XrUnique&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~XrUnique() {
    if (object_ != XR_NULL_HANDLE) destroy(object_);
  }
  T get() const { return object_; }

 private:
  T object_ = XR_NULL_HANDLE;
};

using UniqueXrActionSet = XrUnique<XrActionSet, xrDestroyActionSet>;
using UniqueXrInstance = XrUnique<XrInstance, xrDestroyInstance>;
using UniqueXrSession = XrUnique<XrSession, xrDestroySession>;
using UniqueXrSpace = XrUnique<XrSpace, xrDestroySpace>;
using UniqueXrSwapchain = XrUnique<XrSwapchain, xrDestroySwapchain>;

}  // namespace host
