#pragma once
// The host's VkDevice and its one queue, with what Voyager asks for enabled.
#include <voyager/voyager_vulkan.h>

#include <memory>
#include <string>

#include "creation.h"
#include "gpu.h"
#include "instance.h"

namespace host {

class Device {
 public:
  // The first device that has a queue for graphics (and presentation), an actual GPU before
  // others, whose name has `name` in it. presentation may be NULL.
  Device(const Instance& instance, const Presentation* presentation, const std::string& name);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkDevice get() const { return device_; }
  VkInstance instance() const { return instance_.get(); }
  VkPhysicalDevice physical() const { return physical_; }
  operator Gpu() const { return {physical_, device_, queue_, queue_family_}; }
  VkQueue queue() const { return queue_; }
  uint32_t queue_family() const { return queue_family_; }
  const std::string& name() const { return name_; }
  void wait_idle() const;

  // What voyCreateDevice needs to know. It points into this object.
  VoyVulkanDeviceDesc voyager_desc() const { return creation_->voyager_desc(device_); }

 private:
  const Instance& instance_;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  uint32_t queue_family_ = 0;
  std::string name_;
  std::unique_ptr<DeviceCreation> creation_;
};

}  // namespace host
