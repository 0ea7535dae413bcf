#include "validation.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "failure.h"

namespace host {
namespace {

constexpr VkValidationFeatureEnableEXT kEnabled[] = {
    VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};

template <class Function>
Function find(VkInstance instance, const char* name) {
  return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

}  // namespace

const void* Validation::instance_chain() {
  // Hazards between submissions are an option of its own; later layers always look for them.
  ::setenv("VK_LAYER_ENABLES", "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT",
           0);
  messenger_.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
  messenger_.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                               VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  // Not GENERAL: there the loader talks about the machine.
  messenger_.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  messenger_.pfnUserCallback = report;
  messenger_.pUserData = this;
  features_.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
  features_.pNext = &messenger_;
  features_.enabledValidationFeatureCount = 1;
  features_.pEnabledValidationFeatures = kEnabled;
  return &features_;
}

VkBool32 Validation::report(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* self) {
  ++static_cast<Validation*>(self)->messages_;
  std::fprintf(stderr, "validation: %s\n", data->pMessage);
  return VK_FALSE;
}

ValidationMessenger::ValidationMessenger(VkInstance instance, const Validation& validation)
    : instance_(instance) {
  const auto create =
      find<PFN_vkCreateDebugUtilsMessengerEXT>(instance, "vkCreateDebugUtilsMessengerEXT");
  check(create(instance, &validation.messenger(), nullptr, &messenger_),
        "vkCreateDebugUtilsMessengerEXT");
}

ValidationMessenger::~ValidationMessenger() {
  find<PFN_vkDestroyDebugUtilsMessengerEXT>(instance_, "vkDestroyDebugUtilsMessengerEXT")(
      instance_, messenger_, nullptr);
}

void require_validation_layer() {
  uint32_t count = 0;
  check(vkEnumerateInstanceLayerProperties(&count, nullptr), "vkEnumerateInstanceLayerProperties");
  std::vector<VkLayerProperties> layers(count);
  check(vkEnumerateInstanceLayerProperties(&count, layers.data()),
        "vkEnumerateInstanceLayerProperties");
  for (const VkLayerProperties& layer : layers)
    if (std::strcmp(layer.layerName, kValidationLayer) == 0) return;
  throw Failure(kMachine, std::string("--validation: found no ") + kValidationLayer +
                              ", expected it installed");
}

}  // namespace host
