#include "vulkan_interop/device.h"

#include <algorithm>

#include "runtime/base/error.h"
#include "vulkan_interop/formats.h"
#include "vulkan_interop/resources.h"

namespace voyager::vulkan {
namespace {

std::string not_enabled(const char* extension) {
  return std::string(extension) + " is not enabled";
}

[[noreturn]] void refuse(const char* field, const std::string& why) {
  throw Error(ErrorCode::unsupported, std::string("VoyVulkanDeviceDesc.") + field +
                                          ": found a mode that is not possible here: " + why);
}

}  // namespace

Device::Device(const DeviceDesc& desc, const ExternalSupport& backend)
    : physical_(desc.get, desc.instance, desc.physical_device),
      device_(desc.device),
      vk_(load_device_functions(physical_.functions().GetDeviceProcAddr, desc.device)),
      extensions_(desc.extensions),
      version_(desc.version),
      timelines_(desc.timelines) {
  if (desc.version < kLeastVersion)
    throw Error(ErrorCode::unsupported,
                "VoyVulkanDeviceDesc.vulkanVersion: found a version below Vulkan 1.1, expected 1.1 "
                "or newer");
  choose_sharing(desc.sharing, backend);
  choose_sync(desc.sync, backend);
  imports_host_memory_ = sharing_ == Sharing::host &&
                         enabled(VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME) &&
                         vk_.GetMemoryHostPointerPropertiesEXT != nullptr &&
                         physical_.host_pointer_alignment() != 0 && takes_host_memory(*this);
}

bool Device::enabled(const char* extension) const {
  return std::find(extensions_.begin(), extensions_.end(), extension) != extensions_.end();
}

std::string Device::why_not_shared(const ExternalSupport& backend) const {
  if (!backend.images) return "the backend does not draw on this device";
  if (!enabled(VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME) || vk_.GetMemoryFdKHR == nullptr)
    return not_enabled(VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME);
  for (const VkFormat format : kRingFormats)
    if (!physical_.exports_images(format))
      return "the device exports no images of VkFormat " + std::to_string(format);
  return physical_.exports_buffers() ? "" : "the device exports no buffers";
}

std::string Device::why_no_timelines(const ExternalSupport& backend) const {
  if (!timelines_ || vk_.WaitSemaphores == nullptr || vk_.SignalSemaphore == nullptr ||
      vk_.GetSemaphoreCounterValue == nullptr)
    return "the feature timelineSemaphore is not enabled";
  if (sharing_ == Sharing::host) return "";
  if (!enabled(VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME) || vk_.GetSemaphoreFdKHR == nullptr)
    return not_enabled(VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME);
  if (!physical_.exports_semaphores(true)) return "the device exports no timeline semaphores";
  return backend.timelines ? "" : "the backend takes no timeline semaphores";
}

std::string Device::why_no_binaries(const ExternalSupport& backend) const {
  if (sharing_ == Sharing::host) return "binary semaphores do not work with HOST sharing";
  if (!enabled(VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME) || vk_.GetSemaphoreFdKHR == nullptr)
    return not_enabled(VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME);
  if (!physical_.exports_semaphores(false)) return "the device exports no semaphores";
  return backend.binaries ? "" : "the backend takes no binary semaphores";
}

void Device::choose_sharing(Sharing wanted, const ExternalSupport& backend) {
  const std::string why = why_not_shared(backend);
  if (wanted == Sharing::device && !why.empty()) refuse("sharing", why);
  const bool shared = wanted != Sharing::host && why.empty();
  sharing_ = shared ? Sharing::device : Sharing::host;
  if (wanted == Sharing::automatic) why_ = why;
}

void Device::choose_sync(Sync wanted, const ExternalSupport& backend) {
  const std::string no_timelines = why_no_timelines(backend);
  const std::string no_binaries = why_no_binaries(backend);
  if (wanted == Sync::timeline && !no_timelines.empty()) refuse("sync", no_timelines);
  if (wanted == Sync::binary && !no_binaries.empty()) refuse("sync", no_binaries);
  sync_ = wanted;
  if (wanted != Sync::automatic) return;
  sync_ = no_timelines.empty() ? Sync::timeline : (no_binaries.empty() ? Sync::binary : Sync::host);
  if (!why_.empty() && !no_timelines.empty()) why_ += "; ";
  why_ += no_timelines;
}

}  // namespace voyager::vulkan
