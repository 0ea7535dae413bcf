#include "resources.h"

#include <cstring>

#include "failure.h"

namespace host {
namespace {

// The first type with all of `wanted`, or else with all of `needed`.
uint32_t memory_type(const Gpu& gpu, uint32_t allowed, VkMemoryPropertyFlags wanted,
                     VkMemoryPropertyFlags needed) {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(gpu.physical, &memory);
  for (const VkMemoryPropertyFlags flags : {wanted, needed})
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
      if ((allowed >> i & 1) && (memory.memoryTypes[i].propertyFlags & flags) == flags) return i;
  throw Failure(kMachine, "found no type of memory that serves, expected one");
}

UniqueMemory allocate(const Gpu& gpu, const VkMemoryRequirements& needs,
                      VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags needed) {
  VkMemoryAllocateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  info.allocationSize = needs.size;
  info.memoryTypeIndex = memory_type(gpu, needs.memoryTypeBits, wanted, needed);
  VkDeviceMemory memory = VK_NULL_HANDLE;
  check(vkAllocateMemory(gpu.device, &info, nullptr, &memory), "vkAllocateMemory");
  return {gpu.device, memory};
}

}  // namespace

Image::Image(const Gpu& gpu, VkExtent2D extent, VkFormat format, VkImageUsageFlags usage,
             VkImageAspectFlags aspect) {
  VkImageCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {extent.width, extent.height, 1};
  info.mipLevels = 1;
  info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  VkImage made = VK_NULL_HANDLE;
  check(vkCreateImage(gpu.device, &info, nullptr, &made), "vkCreateImage");
  image = {gpu.device, made};

  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(gpu.device, made, &needs);
  memory = allocate(gpu, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0);
  check(vkBindImageMemory(gpu.device, made, memory.get(), 0), "vkBindImageMemory");

  VkImageViewCreateInfo view_info = {};
  view_info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  view_info.image = made;
  view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view_info.format = format;
  view_info.subresourceRange = {aspect, 0, 1, 0, 1};
  VkImageView made_view = VK_NULL_HANDLE;
  check(vkCreateImageView(gpu.device, &view_info, nullptr, &made_view), "vkCreateImageView");
  view = {gpu.device, made_view};
}

Buffer::Buffer(const Gpu& gpu, VkDeviceSize bytes, VkBufferUsageFlags usage) : size(bytes) {
  VkBufferCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = bytes;
  info.usage = usage;
  VkBuffer made = VK_NULL_HANDLE;
  check(vkCreateBuffer(gpu.device, &info, nullptr, &made), "vkCreateBuffer");
  buffer = {gpu.device, made};

  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(gpu.device, made, &needs);
  const VkMemoryPropertyFlags coherent =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  memory = allocate(gpu, needs, coherent | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, coherent);
  check(vkBindBufferMemory(gpu.device, made, memory.get(), 0), "vkBindBufferMemory");
  void* address = nullptr;
  check(vkMapMemory(gpu.device, memory.get(), 0, VK_WHOLE_SIZE, 0, &address), "vkMapMemory");
  mapped = static_cast<std::byte*>(address);
}

Buffer::Buffer(const Gpu& gpu, std::span<const std::byte> bytes, VkBufferUsageFlags usage)
    : Buffer(gpu, bytes.size(), usage) {
  std::memcpy(mapped, bytes.data(), bytes.size());
}

}  // namespace host
