#pragma once
// The validation layer: its messages go to standard error, and are counted.
#include <vulkan/vulkan.h>

#include <atomic>
#include <cstdint>

namespace host {

inline constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

// Throws Failure where it is not installed.
void require_validation_layer();

class Validation {
 public:
  // To be chained to VkInstanceCreateInfo, so that the instance's own making and unmaking
  // are watched too. Synchronisation validation is on, across submissions too.
  const void* instance_chain();
  const VkDebugUtilsMessengerCreateInfoEXT& messenger() const { return messenger_; }
  uint64_t messages() const { return messages_; }

 private:
  static VKAPI_ATTR VkBool32 VKAPI_CALL report(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                               VkDebugUtilsMessageTypeFlagsEXT types,
                                               const VkDebugUtilsMessengerCallbackDataEXT* data,
                                               void* self);

  std::atomic<uint64_t> messages_ = 0;
  VkDebugUtilsMessengerCreateInfoEXT messenger_ = {};
  VkValidationFeaturesEXT features_ = {};
};

// Listens while there is an instance.
class ValidationMessenger {
 public:
  ValidationMessenger(VkInstance instance, const Validation& validation);
  ~ValidationMessenger();
  ValidationMessenger(const ValidationMessenger&) = delete;
  ValidationMessenger& operator=(const ValidationMessenger&) = delete;

 private:
  VkInstance instance_;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

}  // namespace host
