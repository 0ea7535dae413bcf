#pragma once
// The application's XrInstance: one at a time. What belongs to it and not to a session.
#include <cstring>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "context.h"

namespace test_runtime {

inline constexpr XrSystemId kSystem = 1;

struct Instance final : Object {
  Instance() : Object(nullptr) {}

  bool enabled(const char* extension) const;
  XrPath path(const std::string& text);
  const std::string& text_of(XrPath path) const;  // refuses what is no path of this instance

  std::vector<std::string> extensions;
  std::vector<std::string> paths;  // XrPath is the index and one
  std::deque<XrEventDataBuffer> events;
  bool lost = false;
  int64_t frames_to_loss = -1;  // below 0: not to be lost
  bool requirements_asked = false;
  VkInstance vulkan_instance = VK_NULL_HANDLE;  // that it created
  VkDevice vulkan_device = VK_NULL_HANDLE;
  VkPhysicalDevice vulkan_physical = VK_NULL_HANDLE;
  PFN_vkGetInstanceProcAddr vulkan_get = nullptr;
  // Suggested bindings by profile: binding path and action's handle.
  std::map<std::string, std::vector<std::pair<std::string, uint64_t>>> suggested;
};

// The live one of this handle; refused once it is lost.
Instance& find_instance(XrInstance handle);
void check_system(XrSystemId system);
// Of those that the instance's extensions allow.
void check_view_configuration(const Instance& instance, XrViewConfigurationType type);
// How many views it has, in the order left, right, left inner, right inner.
uint32_t view_count(XrViewConfigurationType type);

template <class Data>
void queue_event(Instance& instance, const Data& data) {
  static_assert(sizeof(Data) <= sizeof(XrEventDataBuffer));
  XrEventDataBuffer buffer = {};
  std::memcpy(static_cast<void*>(&buffer), &data, sizeof data);
  instance.events.push_back(buffer);
}

}  // namespace test_runtime
