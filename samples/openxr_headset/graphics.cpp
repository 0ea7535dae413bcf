#include "graphics.h"

#include <algorithm>
#include <vector>

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
  InstanceCreation creation("openxr_headset", validation, {});
  api_version_ = agree(runtime_, creation.api_version());
  creation.set_api_version(api_version_);

  auto request = xr_struct<XrVulkanInstanceCreateInfoKHR>(XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR);
  request.systemId = runtime_.system();
  request.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
  request.vulkanCreateInfo = &creation.info();
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

  creation_ = std::make_unique<DeviceCreation>(instance_.get(), api_version_, physical_,
                                               queue_family_, std::vector<const char*>());

  auto request = xr_struct<XrVulkanDeviceCreateInfoKHR>(XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR);
  request.systemId = runtime_.system();
  request.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
  request.vulkanPhysicalDevice = physical_;
  request.vulkanCreateInfo = &creation_->info();
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

}  // namespace host
