#include "vulkan_interop/functions.h"

#include <new>
#include <string>

#include "runtime/base/error.h"

namespace voyager::vulkan {
namespace {

[[noreturn]] void fail_missing(const char* name) {
  throw Error(ErrorCode::invalid_argument,
              std::string("getInstanceProcAddr: found no ") + name + ", expected Vulkan 1.1");
}

template <class Function, class Get, class Handle>
void load(Function& into, Get get, Handle handle, const char* name) {
  into = reinterpret_cast<Function>(get(handle, name));
}

}  // namespace

InstanceFunctions load_instance_functions(PFN_vkGetInstanceProcAddr get, VkInstance instance) {
  InstanceFunctions vk;
#define VOYAGER_VULKAN_LOAD(name)          \
  load(vk.name, get, instance, "vk" #name); \
  if (vk.name == nullptr) fail_missing("vk" #name);
  VOYAGER_VULKAN_INSTANCE_FUNCTIONS(VOYAGER_VULKAN_LOAD)
#undef VOYAGER_VULKAN_LOAD
  return vk;
}

DeviceFunctions load_device_functions(PFN_vkGetDeviceProcAddr get, VkDevice device) {
  DeviceFunctions vk;
#define VOYAGER_VULKAN_LOAD(name)        \
  load(vk.name, get, device, "vk" #name); \
  if (vk.name == nullptr) fail_missing("vk" #name);
  VOYAGER_VULKAN_DEVICE_FUNCTIONS(VOYAGER_VULKAN_LOAD)
#undef VOYAGER_VULKAN_LOAD
#define VOYAGER_VULKAN_LOAD(name)        \
  load(vk.name, get, device, "vk" #name); \
  if (vk.name == nullptr) load(vk.name, get, device, "vk" #name "KHR");
  VOYAGER_VULKAN_OPTIONAL_FUNCTIONS(VOYAGER_VULKAN_LOAD)
#undef VOYAGER_VULKAN_LOAD
  return vk;
}

void check(VkResult status, const char* what) {
  if (status >= VK_SUCCESS) return;
  const std::string message =
      std::string("Vulkan: ") + what + ": VkResult " + std::to_string(status);
  switch (status) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      throw std::bad_alloc();
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_TOO_MANY_OBJECTS:
      throw Error(ErrorCode::over_budget, message);
    case VK_ERROR_DEVICE_LOST:
      throw Error(ErrorCode::device_lost, message);
    default:
      throw Error(ErrorCode::internal, message);
  }
}

}  // namespace voyager::vulkan
