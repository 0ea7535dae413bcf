#include "graphics.h"

#include <algorithm>
#include <voyager/voyager.hpp>

#include "failure.h"
#include "warn_once.h"

namespace host {
namespace {

uint32_t to_vulkan(XrVersion version) {
  return VK_MAKE_API_VERSION(0, XR_VERSION_MAJOR(version), XR_VERSION_MINOR(version),
                             XR_VERSION_PATCH(version));
}

std::string text(uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." +
         std::to_string(VK_API_VERSION_MINOR(version));
}

XrGraphicsRequirementsVulkan2KHR requirements(const Runtime& runtime) {
  auto needs =
      xr_struct<XrGraphicsRequirementsVulkan2KHR>(XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR);
  const auto get = runtime.function<PFN_xrGetVulkanGraphicsRequirements2KHR>(
      "xrGetVulkanGraphicsRequirements2KHR");
  check(get(runtime.get(), runtime.system(), &needs), "xrGetVulkanGraphicsRequirements2KHR");
  return needs;
}

// The lowest that both can do. The runtime's maximum is what it was tested with: whether it takes
// more is seen where the instance is made.
uint32_t agree(const Runtime& runtime, uint32_t voyager) {
  const XrGraphicsRequirementsVulkan2KHR needs = requirements(runtime);
  const uint32_t version = std::max(voyager, to_vulkan(needs.minApiVersionSupported));
  const uint32_t most = to_vulkan(needs.maxApiVersionSupported);
  // A runtime of the same minor version takes any patch.
  if (VK_API_VERSION_MAJOR(version) > VK_API_VERSION_MAJOR(most) ||
      (VK_API_VERSION_MAJOR(version) == VK_API_VERSION_MAJOR(most) &&
       VK_API_VERSION_MINOR(version) > VK_API_VERSION_MINOR(most)))
    warn_once(runtime.name() + ": found Vulkan " + text(most) + " tested at most, expected " +
              text(version) + ": trying it");
  return version;
}

uint32_t find_queue_family(VkPhysicalDevice physical) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  for (uint32_t i = 0; i < count; ++i)
    if (families[i].queueCount > 0 && (families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT)) return i;
  throw Failure(kMachine, "found a Vulkan device without a queue for graphics, expected one");
}

}  // namespace

Graphics::Graphics(const Runtime& runtime, Validation* validation) : runtime_(runtime) {
  create_instance(validation);
  if (validation) messenger_ = std::make_unique<ValidationMessenger>(instance_.get(), *validation);
  create_device();
}

void Graphics::create_instance(Validation* validation) {
  // Asked before there is an instance: what any device may need of one.
  VoyVulkanRequirements needs = VOY_VULKAN_REQUIREMENTS_INIT;
  voy::check(voyGetVulkanRequirements(nullptr, &needs));
  api_version_ = agree(runtime_, needs.apiVersion);
  std::vector<const char*> extensions(needs.instanceExtensions,
                                      needs.instanceExtensions + needs.instanceExtensionCount);
  VkApplicationInfo application = {};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.pApplicationName = "openxr_headset";
  application.apiVersion = api_version_;
  VkInstanceCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pApplicationInfo = &application;
  if (validation) {
    require_validation_layer();
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    info.pNext = validation->instance_chain();
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
  }
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();

  auto request = xr_struct<XrVulkanInstanceCreateInfoKHR>(XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR);
  request.systemId = runtime_.system();
  request.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
  request.vulkanCreateInfo = &info;
  VkResult result = VK_SUCCESS;
  const auto create = runtime_.function<PFN_xrCreateVulkanInstanceKHR>("xrCreateVulkanInstanceKHR");
  VkInstance instance = VK_NULL_HANDLE;
  check(create(runtime_.get(), &request, &instance, &result), "xrCreateVulkanInstanceKHR");
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
    throw Failure(kMachine, "found no Vulkan driver, expected one of Vulkan " + text(api_version_));
  check(result, "xrCreateVulkanInstanceKHR: vkCreateInstance");
  instance_.reset(instance);
}

void Graphics::create_device() {
  auto get_info =
      xr_struct<XrVulkanGraphicsDeviceGetInfoKHR>(XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR);
  get_info.systemId = runtime_.system();
  get_info.vulkanInstance = instance_.get();
  const auto get =
      runtime_.function<PFN_xrGetVulkanGraphicsDevice2KHR>("xrGetVulkanGraphicsDevice2KHR");
  check(get(runtime_.get(), &get_info, &physical_), "xrGetVulkanGraphicsDevice2KHR");
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(physical_, &properties);
  name_ = properties.deviceName;
  largest_image_ = properties.limits.maxImageDimension2D;
  queue_family_ = find_queue_family(physical_);

  // What this physical device has of what Voyager can use.
  VoyVulkanPhysicalDevice asked = VOY_VULKAN_PHYSICAL_DEVICE_INIT;
  asked.getInstanceProcAddr = vkGetInstanceProcAddr;
  asked.instance = instance_.get();
  asked.physicalDevice = physical_;
  VoyVulkanRequirements needs = VOY_VULKAN_REQUIREMENTS_INIT;
  voy::check(voyGetVulkanRequirements(&asked, &needs));
  extensions_.assign(needs.deviceExtensions, needs.deviceExtensions + needs.deviceExtensionCount);
  timeline_semaphore_ = needs.timelineSemaphore;

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

  auto request = xr_struct<XrVulkanDeviceCreateInfoKHR>(XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR);
  request.systemId = runtime_.system();
  request.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
  request.vulkanPhysicalDevice = physical_;
  request.vulkanCreateInfo = &info;
  VkResult result = VK_SUCCESS;
  const auto create = runtime_.function<PFN_xrCreateVulkanDeviceKHR>("xrCreateVulkanDeviceKHR");
  VkDevice device = VK_NULL_HANDLE;
  check(create(runtime_.get(), &request, &device, &result), "xrCreateVulkanDeviceKHR");
  check(result, "xrCreateVulkanDeviceKHR: vkCreateDevice");
  device_.reset(device);
  vkGetDeviceQueue(device, queue_family_, 0, &queue_);
}

void Graphics::wait_idle() const {
  check(vkDeviceWaitIdle(device_.get()), "vkDeviceWaitIdle");
}

XrGraphicsBindingVulkan2KHR Graphics::binding() const {
  requirements(runtime_);
  auto binding = xr_struct<XrGraphicsBindingVulkan2KHR>(XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR);
  binding.instance = instance_.get();
  binding.physicalDevice = physical_;
  binding.device = device_.get();
  binding.queueFamilyIndex = queue_family_;
  binding.queueIndex = 0;
  return binding;
}

VoyVulkanDeviceDesc Graphics::voyager_desc() const {
  VoyVulkanDeviceDesc desc = VOY_VULKAN_DEVICE_DESC_INIT;
  desc.getInstanceProcAddr = vkGetInstanceProcAddr;
  desc.instance = instance_.get();
  desc.physicalDevice = physical_;
  desc.device = device_.get();
  desc.apiVersion = api_version_;
  desc.deviceExtensionCount = static_cast<uint32_t>(extensions_.size());
  desc.deviceExtensions = extensions_.data();
  desc.timelineSemaphore = timeline_semaphore_;
  return desc;
}

}  // namespace host
