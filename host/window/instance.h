#pragma once
// The host's VkInstance, with what Voyager asks for enabled.
#include <vulkan/vulkan.h>

#include <memory>
#include <vector>

#include "validation.h"

namespace host {

// What a window adds.
struct Presentation {
  std::vector<const char*> instance_extensions;
  bool (*supports)(VkInstance, VkPhysicalDevice, uint32_t queue_family) = nullptr;
};

class Instance {
 public:
  // validation and presentation may be NULL. `application` is what drivers call the program.
  Instance(const char* application, Validation* validation, const Presentation* presentation);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  VkInstance get() const { return instance_; }
  uint32_t api_version() const { return api_version_; }

 private:
  VkInstance instance_ = VK_NULL_HANDLE;
  uint32_t api_version_ = 0;
  std::unique_ptr<ValidationMessenger> messenger_;
};

}  // namespace host
