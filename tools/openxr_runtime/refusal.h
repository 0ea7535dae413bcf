#pragma once
// How a call ends early. A rule that the application broke is a violation and is reported; what
// it may ask and does not get (too small a capacity, a lost session) is not.
#include <string>

#include "api.h"

namespace test_runtime {

struct Refusal {
  XrResult result;
  std::string what;
  bool violation;
};

[[noreturn]] inline void violation(XrResult result, std::string what) {
  throw Refusal{result, std::move(what), true};
}
[[noreturn]] inline void refuse(XrResult result, std::string what) {
  throw Refusal{result, std::move(what), false};
}

// A structure that the application passes, of the type that its field says.
template <class T>
T& checked(T* structure, XrStructureType type, const char* name) {
  if (!structure) violation(XR_ERROR_VALIDATION_FAILURE, std::string(name) + ": found NULL");
  if (structure->type != type)
    violation(XR_ERROR_VALIDATION_FAILURE, std::string(name) + "->type: found " +
                                               name_of(structure->type) + ", expected " +
                                               name_of(type));
  return *structure;
}

template <class T>
T& checked_pointer(T* pointer, const char* name) {
  if (!pointer) violation(XR_ERROR_VALIDATION_FAILURE, std::string(name) + ": found NULL");
  return *pointer;
}

// The structure of this type in a chain, or nullptr.
template <class T>
const T* chained(const void* next, XrStructureType type) {
  for (auto item = static_cast<const XrBaseInStructure*>(next); item; item = item->next)
    if (item->type == type) return reinterpret_cast<const T*>(item);
  return nullptr;
}

// OpenXR's two calls: how many, then all of them. write(i, items[i]) fills one.
template <class T, class Write>
XrResult enumerate(size_t size, uint32_t capacity, uint32_t* count, T* items, const Write& write) {
  checked_pointer(count, "the count") = static_cast<uint32_t>(size);
  if (capacity == 0) return XR_SUCCESS;
  if (capacity < size)
    refuse(XR_ERROR_SIZE_INSUFFICIENT, "a capacity of " + std::to_string(capacity));
  checked_pointer(items, "the array");
  for (size_t i = 0; i < size; ++i) write(i, items[i]);
  return XR_SUCCESS;
}

}  // namespace test_runtime
