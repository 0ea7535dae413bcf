#include "plugin/vulkan_device.h"

#include <algorithm>

#include "plugin/call.h"
#include "plugin/structs.h"
#include "plugin/text.h"

using namespace voyager;

namespace {

// What the hand-off can use, the most useful first.
constexpr const char* kDeviceExtensions[] = {
    VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME, VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME,
    VK_KHR_TIMELINE_SEMAPHORE_EXTENSION_NAME, VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME};
constexpr uint32_t kCount = std::size(kDeviceExtensions);

// A list for each subset, so that what a call returned stays as it was.
const char* const* extension_list(uint32_t subset) {
  static const auto lists = [] {
    std::array<std::array<const char*, kCount>, 1u << kCount> made{};
    for (uint32_t bits = 0; bits < made.size(); ++bits) {
      size_t count = 0;
      for (uint32_t i = 0; i < kCount; ++i)
        if ((bits >> i & 1) != 0) made[bits][count++] = kDeviceExtensions[i];
    }
    return made;
  }();
  return lists[subset].data();
}

template <class Desc>
void check_vulkan(const Desc& desc, const FieldName& name) {
  check_pointer(reinterpret_cast<const void*>(desc.getInstanceProcAddr),
                name + ".getInstanceProcAddr");
  check_pointer(desc.instance, name + ".instance");
  check_pointer(desc.physicalDevice, name + ".physicalDevice");
}

void describe(const VoyVulkanPhysicalDevice& desc, VoyVulkanRequirements& out) {
  const vulkan::PhysicalDevice device(desc.getInstanceProcAddr, desc.instance, desc.physicalDevice);
  uint32_t subset = 0;
  for (uint32_t i = 0; i < kCount; ++i)
    if (device.has(kDeviceExtensions[i])) subset |= 1u << i;
  out.deviceExtensions = extension_list(subset);
  out.deviceExtensionCount = static_cast<uint32_t>(__builtin_popcount(subset));
  out.timelineSemaphore = device.has_timelines() ? VK_TRUE : VK_FALSE;
}

void describe_any(VoyVulkanRequirements& out) {
  out.deviceExtensions = extension_list((1u << kCount) - 1);
  out.deviceExtensionCount = kCount;
  out.timelineSemaphore = VK_TRUE;
}

vulkan::Sharing sharing_of(VoyVulkanSharing sharing) {
  switch (sharing) {
    case VOY_VULKAN_SHARING_DEVICE:
      return vulkan::Sharing::device;
    case VOY_VULKAN_SHARING_HOST:
      return vulkan::Sharing::host;
    default:
      return vulkan::Sharing::automatic;
  }
}

vulkan::Sync sync_of(VoyVulkanSync sync) {
  switch (sync) {
    case VOY_VULKAN_SYNC_TIMELINE:
      return vulkan::Sync::timeline;
    case VOY_VULKAN_SYNC_BINARY:
      return vulkan::Sync::binary;
    case VOY_VULKAN_SYNC_HOST:
      return vulkan::Sync::host;
    default:
      return vulkan::Sync::automatic;
  }
}

VoyVulkanSync sync_of(vulkan::Sync sync) {
  switch (sync) {
    case vulkan::Sync::timeline:
      return VOY_VULKAN_SYNC_TIMELINE;
    case vulkan::Sync::binary:
      return VOY_VULKAN_SYNC_BINARY;
    default:
      return VOY_VULKAN_SYNC_HOST;
  }
}

}  // namespace

vulkan::DeviceDesc voyager::vulkan_device_desc(const VoyVulkanDeviceDesc& desc) {
  const FieldName name = "VoyVulkanDeviceDesc";
  check_vulkan(desc, name);
  check_pointer(desc.device, name + ".device");
  check_enum(desc.sharing, VOY_VULKAN_SHARING_HOST, name + ".sharing");
  check_enum(desc.sync, VOY_VULKAN_SYNC_HOST, name + ".sync");
  check_count(desc.deviceExtensionCount, 0, 4096, name + ".deviceExtensionCount");
  if (desc.deviceExtensionCount > 0)
    check_pointer(desc.deviceExtensions, name + ".deviceExtensions");
  vulkan::DeviceDesc out;
  out.get = desc.getInstanceProcAddr;
  out.instance = desc.instance;
  out.physical_device = desc.physicalDevice;
  out.device = desc.device;
  out.version = desc.vulkanVersion;
  for (uint32_t i = 0; i < desc.deviceExtensionCount; ++i) {
    check_pointer(desc.deviceExtensions[i], {"VoyVulkanDeviceDesc.deviceExtensions", i});
    out.extensions.emplace_back(desc.deviceExtensions[i]);
  }
  out.timelines = desc.timelineSemaphore != VK_FALSE;
  out.sharing = sharing_of(desc.sharing);
  out.sync = sync_of(desc.sync);
  return out;
}

void voyager::fill(VoyVulkanCapabilities& out, const vulkan::Device& device) {
  const bool shared = device.sharing() == vulkan::Sharing::device;
  out.sharing = shared ? VOY_VULKAN_SHARING_DEVICE : VOY_VULKAN_SHARING_HOST;
  out.sync = sync_of(device.sync());
  out.hostMemoryImport = device.imports_host_memory() ? VK_TRUE : VK_FALSE;
  std::fill(std::begin(out.why), std::end(out.why), '\0');
  put_text(device.why(), out.why);
}

VoyResult VOY_CALL voyGetVulkanRequirements(const VoyVulkanPhysicalDevice* physicalDevice,
                                            VoyVulkanRequirements* requirements) {
  return guarded("voyGetVulkanRequirements", [&](Call&) {
    check_structure(requirements, VOY_STRUCTURE_TYPE_VULKAN_REQUIREMENTS, "VoyVulkanRequirements");
    VoyVulkanRequirements found = VOY_VULKAN_REQUIREMENTS_INIT;
    found.vulkanVersion = vulkan::kLeastVersion;
    if (physicalDevice == nullptr) {
      describe_any(found);
    } else {
      check_structure(physicalDevice, VOY_STRUCTURE_TYPE_VULKAN_PHYSICAL_DEVICE,
                      "VoyVulkanPhysicalDevice");
      check_vulkan(*physicalDevice, "VoyVulkanPhysicalDevice");
      describe(*physicalDevice, found);
    }
    *requirements = found;
    return VOY_SUCCESS;
  });
}
