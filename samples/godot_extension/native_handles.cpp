#include "native_handles.h"

#include <dlfcn.h>

#include <bit>
#include <stdexcept>

#include "godot.h"

namespace voyager_godot {
namespace {

// RenderingDevice.DriverResource.
enum DriverResource : int64_t {
  kLogicalDevice = 0,
  kPhysicalDevice = 1,
  kTopmostObject = 2,
  kCommandQueue = 3,
  kQueueFamily = 4,
  kTexture = 5
};

// The hash names the method's signature in Godot's API.
constexpr int64_t kGetDriverResourceHash = 501815484;

uint64_t driver_resource(void* rendering_device, int64_t resource, uint64_t rid = 0) {
  StringName class_name("RenderingDevice"), method("get_driver_resource");
  void* bind = godot.get_method_bind(class_name.get(), method.get(), kGetDriverResourceHash);
  if (!bind)
    throw std::runtime_error(
        "RenderingDevice.get_driver_resource: found another signature, expected Godot's since 4.0");
  const uint64_t index = 0;
  const void* arguments[] = {&resource, &rid, &index};
  uint64_t found = 0;
  godot.ptrcall(bind, rendering_device, arguments, &found);
  return found;
}

template <class Handle>
Handle handle_of(uint64_t value) {
  return std::bit_cast<Handle>(value);
}

}  // namespace

VulkanLoader::VulkanLoader() : library_(::dlopen("libvulkan.so.1", RTLD_NOW), ::dlclose) {
  if (!library_) throw std::runtime_error("found no libvulkan.so.1, expected Vulkan's loader");
  get_ =
      reinterpret_cast<PFN_vkGetInstanceProcAddr>(::dlsym(library_.get(), "vkGetInstanceProcAddr"));
}

NativeDevice native_device(void* rendering_device) {
  if (!rendering_device)
    throw std::runtime_error(
        "found no RenderingDevice, expected the renderer Forward+ or Mobile (Project Settings)");
  StringName class_name("RenderingDevice");
  if (!godot.object_cast_to(rendering_device, godot.class_tag(class_name.get())))
    throw std::runtime_error("found another object, expected a RenderingDevice");
  NativeDevice native = {
      handle_of<VkInstance>(driver_resource(rendering_device, kTopmostObject)),
      handle_of<VkPhysicalDevice>(driver_resource(rendering_device, kPhysicalDevice)),
      handle_of<VkDevice>(driver_resource(rendering_device, kLogicalDevice)),
      handle_of<VkQueue>(driver_resource(rendering_device, kCommandQueue)),
      static_cast<uint32_t>(driver_resource(rendering_device, kQueueFamily))};
  if (!native.instance || !native.physical || !native.device || !native.queue)
    throw std::runtime_error("found no Vulkan device, expected the rendering driver vulkan");
  return native;
}

VkImage native_image(void* rendering_device, uint64_t rid) {
  const uint64_t image = driver_resource(rendering_device, kTexture, rid);
  if (image == 0)
    throw std::runtime_error("found a RID without an image, expected a texture of RenderingDevice");
  return handle_of<VkImage>(image);
}

}  // namespace voyager_godot
