#pragma once
// Buffers and images of the test's own.
#include "vulkan_host.h"

// Mapped, for what is copied to and from images.
struct MappedBuffer {
  MappedBuffer(const VulkanHost& owner, VkDeviceSize bytes) : host(owner) {
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes;
    info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    VK(vkCreateBuffer(host.device, &info, nullptr, &buffer));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(host.device, buffer, &needs);
    const VkMemoryAllocateInfo allocate{
        VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size,
        host.memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                                   VK_MEMORY_PROPERTY_HOST_COHERENT_BIT)};
    VK(vkAllocateMemory(host.device, &allocate, nullptr, &memory));
    VK(vkBindBufferMemory(host.device, buffer, memory, 0));
    VK(vkMapMemory(host.device, memory, 0, VK_WHOLE_SIZE, 0, &data));
  }
  ~MappedBuffer() {
    vkDestroyBuffer(host.device, buffer, nullptr);
    vkFreeMemory(host.device, memory, nullptr);
  }
  MappedBuffer(const MappedBuffer&) = delete;
  MappedBuffer& operator=(const MappedBuffer&) = delete;

  template <class T>
  std::vector<T> read(size_t count) const {
    std::vector<T> values(count);
    if (count != 0) std::memcpy(values.data(), data, count * sizeof(T));
    return values;
  }

  const VulkanHost& host;
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  void* data = nullptr;
};

struct ImageDesc {
  VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
  uint32_t width = 1, height = 1, layers = 1;
  VkImageUsageFlags usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
  bool exported = false;
};

// Of a texture that is drawn to, with depth where the format has it.
inline ImageDesc attachment(VkFormat format, uint32_t width, uint32_t height) {
  ImageDesc desc;
  desc.format = format;
  desc.width = width;
  desc.height = height;
  const bool is_depth = format >= VK_FORMAT_D16_UNORM && format <= VK_FORMAT_D32_SFLOAT_S8_UINT;
  if (is_depth) desc.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
  if (format == VK_FORMAT_D32_SFLOAT_S8_UINT || format == VK_FORMAT_D24_UNORM_S8_UINT)
    desc.aspect |= VK_IMAGE_ASPECT_STENCIL_BIT;
  desc.usage |=
      is_depth ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  return desc;
}

// Without memory.
inline VkImage make_host_image(const VulkanHost& host, const ImageDesc& desc) {
  const VkExternalMemoryImageCreateInfo external{
      VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_IMAGE_CREATE_INFO, nullptr,
      VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT};
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.pNext = desc.exported ? &external : nullptr;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = desc.format;
  info.extent = {desc.width, desc.height, 1};
  info.mipLevels = 1;
  info.arrayLayers = desc.layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = desc.usage;
  VkImage image = VK_NULL_HANDLE;
  VK(vkCreateImage(host.device, &info, nullptr, &image));
  return image;
}

inline int export_memory_fd(const VulkanHost& host, VkDeviceMemory memory) {
  const auto get =
      reinterpret_cast<PFN_vkGetMemoryFdKHR>(vkGetDeviceProcAddr(host.device, "vkGetMemoryFdKHR"));
  const VkMemoryGetFdInfoKHR info{VK_STRUCTURE_TYPE_MEMORY_GET_FD_INFO_KHR, nullptr, memory,
                                  VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT};
  int fd = -1;
  VK(get(host.device, &info, &fd));
  return fd;
}

struct HostImage {
  HostImage(const VulkanHost& owner, const ImageDesc& from)
      : host(owner), desc(from), image(make_host_image(owner, from)) {
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(host.device, image, &needs);
    bytes = needs.size;
    const VkMemoryDedicatedAllocateInfo dedicated{VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO,
                                                  nullptr, image, VK_NULL_HANDLE};
    const VkExportMemoryAllocateInfo exported{VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO,
                                              &dedicated,
                                              VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT};
    const VkMemoryAllocateInfo allocate{
        VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, desc.exported ? &exported : nullptr, needs.size,
        host.memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)};
    VK(vkAllocateMemory(host.device, &allocate, nullptr, &memory));
    VK(vkBindImageMemory(host.device, image, memory, 0));
  }
  ~HostImage() {
    vkDestroyImage(host.device, image, nullptr);
    vkFreeMemory(host.device, memory, nullptr);
  }
  HostImage(const HostImage&) = delete;
  HostImage& operator=(const HostImage&) = delete;

  int export_fd() const { return export_memory_fd(host, memory); }

  void barrier(VkCommandBuffer commands, VkImageLayout from, VkImageLayout to) const {
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {desc.aspect, 0, 1, 0, desc.layers};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1,
                         &barrier);
  }

  const VulkanHost& host;
  ImageDesc desc;
  VkImage image = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceSize bytes = 0;
};

// A layer, tightly packed, into the buffer.
inline void copy_to_buffer(VkCommandBuffer commands, VkImage image, VkImageLayout layout,
                           const VkExtent2D& size, uint32_t layer, VkImageAspectFlags aspect,
                           const MappedBuffer& into, VkDeviceSize offset = 0) {
  const VkBufferImageCopy region{
      offset, 0, 0, {aspect, 0, layer, 1}, {0, 0, 0}, {size.width, size.height, 1}};
  vkCmdCopyImageToBuffer(commands, image, layout, into.buffer, 1, &region);
  VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_TRANSFER_WRITE_BIT,
                          VK_ACCESS_HOST_READ_BIT};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                       &barrier, 0, nullptr, 0, nullptr);
}
