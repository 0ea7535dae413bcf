#include "instance.h"

#include <voyager/voyager_vulkan.h>

#include <algorithm>
#include <voyager/voyager.hpp>

#include "failure.h"

namespace host {

Instance::Instance(const char* name, Validation* validation, const Presentation* presentation) {
  // Asked before there is an instance: what any device may need of one.
  VoyVulkanRequirements needs = VOY_VULKAN_REQUIREMENTS_INIT;
  voy::check(voyGetVulkanRequirements(nullptr, &needs));
  api_version_ = std::max<uint32_t>(needs.apiVersion, VK_API_VERSION_1_1);
  std::vector<const char*> extensions(needs.instanceExtensions,
                                      needs.instanceExtensions + needs.instanceExtensionCount);
  if (presentation)
    extensions.insert(extensions.end(), presentation->instance_extensions.begin(),
                      presentation->instance_extensions.end());

  VkApplicationInfo application = {};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.pApplicationName = name;
  application.apiVersion = api_version_;
  VkInstanceCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pApplicationInfo = &application;
  if (validation) {
    require_validation_layer();
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    info.pNext = validation->instance_chain();
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
  }
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
    throw Failure(kMachine, "found no Vulkan driver, expected one of Vulkan 1.1 or newer");
  check(result, "vkCreateInstance");
  if (validation) messenger_ = std::make_unique<ValidationMessenger>(instance_, *validation);
}

Instance::~Instance() {
  messenger_.reset();
  vkDestroyInstance(instance_, nullptr);
}

}  // namespace host
