#include "resources.h"

#include <cstring>

#include "failure.h"

namespace host {
namespace {

// The first type with all of `wanted`, or else with all of `needed`.
uint32_t memory_type(const Device& device, uint32_t allowed, VkMemoryPropertyFlags wanted,
                     VkMemoryPropertyFlags needed) {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(device.physical(), &memory);
  for (const VkMemoryPropertyFlags flags : {wanted, needed})
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
      if ((allowed >> i & 1) && (memory.memoryTypes[i].propertyFlags & flags) == flags) return i;
  throw Failure(kMachine, "found no type of memory that serves, expected one");
}

UniqueMemory allocate(const Device& device, const VkMemoryRequirements& needs,
                      VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags needed) {
  VkMemoryAllocateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  info.allocationSize = needs.size;
  info.memoryTypeIndex = memory_type(device, needs.memoryTypeBits, wanted, needed);
  VkDeviceMemory memory = VK_NULL_HANDLE;
  check(vkAllocateMemory(device.get(), &info, nullptr, &memory), "vkAllocateMemory");
  return {device.get(), memory};
}

}  // namespace

Image::Image(const Device& device, VkExtent2D extent, VkFormat format, VkImageUsageFlags usage,
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
  check(vkCreateImage(device.get(), &info, nullptr, &made), "vkCreateImage");
  image = {device.get(), made};

  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device.get(), made, &needs);
  memory = allocate(device, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0);
  check(vkBindImageMemory(device.get(), made, memory.get(), 0), "vkBindImageMemory");

  VkImageViewCreateInfo view_info = {};
  view_info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  view_info.image = made;
  view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view_info.format = format;
  view_info.subresourceRange = {aspect, 0, 1, 0, 1};
  VkImageView made_view = VK_NULL_HANDLE;
  check(vkCreateImageView(device.get(), &view_info, nullptr, &made_view), "vkCreateImageView");
  view = {device.get(), made_view};
}

Buffer::Buffer(const Device& device, VkDeviceSize bytes, VkBufferUsageFlags usage) : size(bytes) {
  VkBufferCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = bytes;
  info.usage = usage;
  VkBuffer made = VK_NULL_HANDLE;
  check(vkCreateBuffer(device.get(), &info, nullptr, &made), "vkCreateBuffer");
  buffer = {device.get(), made};

  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device.get(), made, &needs);
  const VkMemoryPropertyFlags coherent =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  memory = allocate(device, needs, coherent | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, coherent);
  check(vkBindBufferMemory(device.get(), made, memory.get(), 0), "vkBindBufferMemory");
  void* address = nullptr;
  check(vkMapMemory(device.get(), memory.get(), 0, VK_WHOLE_SIZE, 0, &address), "vkMapMemory");
  mapped = static_cast<std::byte*>(address);
}

Buffer::Buffer(const Device& device, std::span<const std::byte> bytes, VkBufferUsageFlags usage)
    : Buffer(device, bytes.size(), usage) {
  std::memcpy(mapped, bytes.data(), bytes.size());
}

}  // namespace host
