#include "device.h"

#include <optional>
#include <voyager/voyager.hpp>

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
  create(presentation != nullptr);
}

void Device::create(bool with_swapchain) {
  // What this physical device has of what Voyager can use.
  VoyVulkanPhysicalDevice asked = VOY_VULKAN_PHYSICAL_DEVICE_INIT;
  asked.getInstanceProcAddr = vkGetInstanceProcAddr;
  asked.instance = instance_.get();
  asked.physicalDevice = physical_;
  VoyVulkanRequirements needs = VOY_VULKAN_REQUIREMENTS_INIT;
  voy::check(voyGetVulkanRequirements(&asked, &needs));
  extensions_.assign(needs.deviceExtensions, needs.deviceExtensions + needs.deviceExtensionCount);
  timeline_semaphore_ = needs.timelineSemaphore;
  if (with_swapchain) extensions_.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);

  const float priority = 1;
  VkDeviceQueueCreateInfo queue = {};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = queue_family_;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkPhysicalDeviceTimelineSemaphoreFeatures timeline = {};
  timeline.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES;
  timeline.timelineSemaphore = VK_TRUE;
  VkDeviceCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  if (timeline_semaphore_) info.pNext = &timeline;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = static_cast<uint32_t>(extensions_.size());
  info.ppEnabledExtensionNames = extensions_.data();
  check(vkCreateDevice(physical_, &info, nullptr, &device_), "vkCreateDevice");
  vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
}

Device::~Device() {
  vkDestroyDevice(device_, nullptr);
}

void Device::wait_idle() const {
  check(vkDeviceWaitIdle(device_), "vkDeviceWaitIdle");
}

VoyVulkanDeviceDesc Device::voyager_desc() const {
  VoyVulkanDeviceDesc desc = VOY_VULKAN_DEVICE_DESC_INIT;
  desc.getInstanceProcAddr = vkGetInstanceProcAddr;
  desc.instance = instance_.get();
  desc.physicalDevice = physical_;
  desc.device = device_;
  desc.apiVersion = instance_.api_version();
  desc.deviceExtensionCount = static_cast<uint32_t>(extensions_.size());
  desc.deviceExtensions = extensions_.data();
  desc.timelineSemaphore = timeline_semaphore_;
  return desc;
}

}  // namespace host
