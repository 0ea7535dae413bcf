#include "device.h"

#include <optional>
#include <vector>

#include "failure.h"

namespace host {
namespace {

struct Choice {
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  uint32_t queue_family = 0;
  int rank = -1;
  std::string name;
};

int rank(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 3;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 2;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 1;
    default:
      return 0;
  }
}

std::optional<uint32_t> find_queue_family(VkInstance instance, VkPhysicalDevice physical,
                                          const Presentation* presentation) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  for (uint32_t i = 0; i < count; ++i)
    if ((families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) &&
        (!presentation || presentation->supports(instance, physical, i)))
      return i;
  return std::nullopt;
}

Choice choose(VkInstance instance, const Presentation* presentation, const std::string& name) {
  uint32_t count = 0;
  check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> devices(count);
  check(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "vkEnumeratePhysicalDevices");
  Choice best;
  std::string seen;
  for (const VkPhysicalDevice physical : devices) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(physical, &properties);
    seen += (seen.empty() ? "" : ", ") + std::string(properties.deviceName);
    const auto family = find_queue_family(instance, physical, presentation);
    if (!family || properties.apiVersion < VK_API_VERSION_1_1 ||
        std::string(properties.deviceName).find(name) == std::string::npos)
      continue;
    if (rank(properties.deviceType) > best.rank)
      best = {physical, *family, rank(properties.deviceType), properties.deviceName};
  }
  if (best.rank >= 0) return best;
  throw Failure(kMachine, "found " + (seen.empty() ? "no Vulkan device" : "only " + seen) +
                              ", expected a Vulkan 1.1 device with a queue for graphics" +
                              (presentation ? " and presentation" : "") +
                              (name.empty() ? "" : " whose name has " + name + " in it"));
}

}  // namespace

Device::Device(const Instance& instance, const Presentation* presentation, const std::string& name)
    : instance_(instance) {
  const Choice choice = choose(instance.get(), presentation, name);
  physical_ = choice.physical;
  queue_family_ = choice.queue_family;
  name_ = choice.name;
  std::vector<const char*> extensions;
  if (presentation) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  creation_ = std::make_unique<DeviceCreation>(instance.get(), instance.api_version(), physical_,
                                               queue_family_, extensions);
  check(vkCreateDevice(physical_, &creation_->info(), nullptr, &device_), "vkCreateDevice");
  vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
}

Device::~Device() {
  vkDestroyDevice(device_, nullptr);
}

void Device::wait_idle() const {
  check(vkDeviceWaitIdle(device_), "vkDeviceWaitIdle");
}

}  // namespace host
