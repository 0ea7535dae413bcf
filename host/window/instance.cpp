#include "instance.h"

#include "creation.h"
#include "failure.h"

namespace host {

Instance::Instance(const char* name, Validation* validation, const Presentation* presentation) {
  const InstanceCreation creation(
      name, validation,
      presentation ? presentation->instance_extensions : std::vector<const char*>());
  api_version_ = creation.api_version();
  const VkResult result = vkCreateInstance(&creation.info(), nullptr, &instance_);
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
