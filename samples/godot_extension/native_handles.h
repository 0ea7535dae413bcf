#pragma once
// Godot's Vulkan objects, from RenderingDevice.get_driver_resource.
#include <voyager/voyager_vulkan.h>

#include <memory>

namespace voyager_godot {

// Vulkan's loader, which Godot has loaded.
class VulkanLoader {
 public:
  // Throws std::runtime_error without one.
  VulkanLoader();
  PFN_vkGetInstanceProcAddr get_instance_proc_addr() const { return get_; }

 private:
  std::unique_ptr<void, int (*)(void*)> library_;
  PFN_vkGetInstanceProcAddr get_;
};

struct NativeDevice {
  VkInstance instance;
  VkPhysicalDevice physical;
  VkDevice device;
  VkQueue queue;
  uint32_t queue_family;
};

// `rendering_device` is Godot's object, NULL with the Compatibility renderer. On the rendering
// thread. Throws std::runtime_error where it does not draw with Vulkan.
NativeDevice native_device(void* rendering_device);

// The image of a texture that `rid` names. Throws std::runtime_error for another RID.
VkImage native_image(void* rendering_device, uint64_t rid);

}  // namespace voyager_godot
