#pragma once
// The Vulkan instance and device that the OpenXR runtime makes, with what Voyager asks for.
#include <voyager/voyager_vulkan.h>

#include <memory>
#include <string>

#include "creation.h"
#include "gpu.h"
#include "runtime.h"
#include "validation.h"

namespace host {

struct DestroyInstance {
  void operator()(VkInstance instance) const { vkDestroyInstance(instance, nullptr); }
};
struct DestroyDevice {
  void operator()(VkDevice device) const { vkDestroyDevice(device, nullptr); }
};

class Graphics {
 public:
  // validation may be NULL.
  Graphics(const Runtime& runtime, Validation* validation);

  VkDevice get() const { return device_.get(); }
  VkPhysicalDevice physical() const { return physical_; }
  operator Gpu() const { return {physical_, device_.get(), queue_, queue_family_}; }
  VkQueue queue() const { return queue_; }
  uint32_t queue_family() const { return queue_family_; }
  const std::string& name() const { return name_; }
  uint32_t largest_image() const { return largest_image_; }  // pixels a side
  void wait_idle() const;

  // What xrCreateSession wants. Asks, as it must, for the runtime's requirements first.
  XrGraphicsBindingVulkan2KHR binding() const;
  // What voyCreateDevice needs to know. It points into this object.
  VoyVulkanDeviceDesc voyager_desc() const { return creation_->voyager_desc(device_.get()); }

 private:
  void create_instance(Validation* validation);
  void create_device();

  const Runtime& runtime_;
  std::unique_ptr<VkInstance_T, DestroyInstance> instance_;
  std::unique_ptr<ValidationMessenger> messenger_;
  std::unique_ptr<VkDevice_T, DestroyDevice> device_;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  uint32_t queue_family_ = 0, api_version_ = 0, largest_image_ = 0;
  std::string name_;
  std::unique_ptr<DeviceCreation> creation_;
};

}  // namespace host
