#include "gpu.h"

#include <cstring>
#include <stdexcept>
#include <string>
#include <voyager/voyager.hpp>

void check(VkResult result, const char* call) {
  if (result != VK_SUCCESS)
    throw std::runtime_error(std::string(call) + ": found VkResult " + std::to_string(result) +
                             ", expected VK_SUCCESS");
}

Gpu::Gpu() {
  make_instance();
  make_device();
  vkGetDeviceQueue(device, queue_family, 0, &queue);
  VkCommandPoolCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  info.queueFamilyIndex = queue_family;
  check(vkCreateCommandPool(device, &info, nullptr, &pool_), "vkCreateCommandPool");
}

Gpu::~Gpu() {
  vkDestroyCommandPool(device, pool_, nullptr);
  vkDestroyDevice(device, nullptr);
  vkDestroyInstance(instance, nullptr);
}

void Gpu::make_instance() {
  VoyVulkanRequirements needs = VOY_VULKAN_REQUIREMENTS_INIT;
  voy::check(voyGetVulkanRequirements(nullptr, &needs));
  VkApplicationInfo application = {};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.apiVersion = needs.vulkanVersion;
  VkInstanceCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pApplicationInfo = &application;
  info.enabledExtensionCount = needs.instanceExtensionCount;
  info.ppEnabledExtensionNames = needs.instanceExtensions;
  check(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
}

// The first physical device. Its first queue family draws, on every GPU that there is.
void Gpu::make_device() {
  uint32_t count = 1;
  vkEnumeratePhysicalDevices(instance, &count, &physical);
  if (count == 0) throw std::runtime_error("found no Vulkan device");
  VoyVulkanPhysicalDevice asked = VOY_VULKAN_PHYSICAL_DEVICE_INIT;
  asked.getInstanceProcAddr = vkGetInstanceProcAddr;
  asked.instance = instance;
  asked.physicalDevice = physical;
  VoyVulkanRequirements needs = VOY_VULKAN_REQUIREMENTS_INIT;
  voy::check(voyGetVulkanRequirements(&asked, &needs));
  extensions_.assign(needs.deviceExtensions, needs.deviceExtensions + needs.deviceExtensionCount);
  timelines_ = needs.timelineSemaphore;

  VkPhysicalDeviceTimelineSemaphoreFeatures timeline = {};
  timeline.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES;
  timeline.timelineSemaphore = VK_TRUE;
  const float priority = 1;
  VkDeviceQueueCreateInfo queues = {};
  queues.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queues.queueFamilyIndex = queue_family;
  queues.queueCount = 1;
  queues.pQueuePriorities = &priority;
  VkDeviceCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pNext = timelines_ ? &timeline : nullptr;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queues;
  info.enabledExtensionCount = static_cast<uint32_t>(extensions_.size());
  info.ppEnabledExtensionNames = extensions_.data();
  check(vkCreateDevice(physical, &info, nullptr, &device), "vkCreateDevice");
}

VoyVulkanDeviceDesc Gpu::voyager_desc() const {
  VoyVulkanDeviceDesc desc = VOY_VULKAN_DEVICE_DESC_INIT;
  desc.getInstanceProcAddr = vkGetInstanceProcAddr;
  desc.instance = instance;
  desc.physicalDevice = physical;
  desc.device = device;
  desc.vulkanVersion = VK_API_VERSION_1_1;
  desc.deviceExtensionCount = static_cast<uint32_t>(extensions_.size());
  desc.deviceExtensions = extensions_.data();
  desc.timelineSemaphore = timelines_;
  return desc;
}

uint32_t Gpu::memory_type(uint32_t types, VkMemoryPropertyFlags flags) const {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(physical, &memory);
  for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
    if ((types >> i & 1) && (memory.memoryTypes[i].propertyFlags & flags) == flags) return i;
  throw std::runtime_error("found no memory type for an image or a buffer");
}

void Gpu::run(const Point& wait, const Point& signal,
              const std::function<void(VkCommandBuffer)>& record) const {
  VkCommandBufferAllocateInfo allocate = {};
  allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  allocate.commandPool = pool_;
  allocate.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vkAllocateCommandBuffers(device, &allocate, &commands), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin = {};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  record(commands);
  check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");

  const VkPipelineStageFlags stages = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
  VkTimelineSemaphoreSubmitInfo values = {};
  values.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO;
  VkSubmitInfo submit = {};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.pNext = &values;
  submit.waitSemaphoreCount = values.waitSemaphoreValueCount = wait.timeline ? 1 : 0;
  submit.pWaitSemaphores = &wait.timeline;
  submit.pWaitDstStageMask = &stages;
  values.pWaitSemaphoreValues = &wait.value;
  submit.signalSemaphoreCount = values.signalSemaphoreValueCount = signal.timeline ? 1 : 0;
  submit.pSignalSemaphores = &signal.timeline;
  values.pSignalSemaphoreValues = &signal.value;
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  check(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
  check(vkQueueWaitIdle(queue), "vkQueueWaitIdle");
  vkFreeCommandBuffers(device, pool_, 1, &commands);
}

Picture::Picture(const Gpu& owner, VkExtent2D size) : gpu(owner), extent(size) {
  VkImageCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.extent = {extent.width, extent.height, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  check(vkCreateImage(gpu.device, &info, nullptr, &image), "vkCreateImage");
  VkBufferCreateInfo bytes = {};
  bytes.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  bytes.size = VkDeviceSize{4} * extent.width * extent.height;
  bytes.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  check(vkCreateBuffer(gpu.device, &bytes, nullptr, &buffer), "vkCreateBuffer");
  VkMemoryRequirements needs[2];
  vkGetImageMemoryRequirements(gpu.device, image, &needs[0]);
  vkGetBufferMemoryRequirements(gpu.device, buffer, &needs[1]);
  const VkMemoryPropertyFlags flags[] = {
      VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT};
  for (int i = 0; i < 2; ++i) {
    VkMemoryAllocateInfo allocate = {};
    allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocate.allocationSize = needs[i].size;
    allocate.memoryTypeIndex = gpu.memory_type(needs[i].memoryTypeBits, flags[i]);
    check(vkAllocateMemory(gpu.device, &allocate, nullptr, &memories[i]), "vkAllocateMemory");
  }
  check(vkBindImageMemory(gpu.device, image, memories[0], 0), "vkBindImageMemory");
  check(vkBindBufferMemory(gpu.device, buffer, memories[1], 0), "vkBindBufferMemory");
  check(vkMapMemory(gpu.device, memories[1], 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
}

Picture::~Picture() {
  vkDestroyBuffer(gpu.device, buffer, nullptr);
  vkDestroyImage(gpu.device, image, nullptr);
  for (const VkDeviceMemory memory : memories) vkFreeMemory(gpu.device, memory, nullptr);
}

void Picture::barrier(VkCommandBuffer commands, VkImageLayout from, VkImageLayout to) const {
  VkImageMemoryBarrier barrier = {};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0,
                       0, nullptr, 0, nullptr, 1, &barrier);
}

std::vector<unsigned char> Picture::read() const {
  gpu.run({}, {}, [this](VkCommandBuffer commands) {
    VkBufferImageCopy whole = {};
    whole.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    whole.imageExtent = {extent.width, extent.height, 1};
    vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1,
                           &whole);
  });
  std::vector<unsigned char> bytes(size_t{4} * extent.width * extent.height);
  std::memcpy(bytes.data(), mapped, bytes.size());
  return bytes;
}
