#include "readback.h"

#include <cmath>
#include <cstring>

#include "swapchain.h"

namespace test_runtime {
namespace {

// A buffer that the host reads.
class HostBuffer {
 public:
  HostBuffer(const Device& device, VkDeviceSize size) : device_(device) {
    try {
      create(size);
    } catch (...) {
      destroy();
      throw;
    }
  }
  ~HostBuffer() { destroy(); }
  HostBuffer(const HostBuffer&) = delete;
  HostBuffer& operator=(const HostBuffer&) = delete;

  VkBuffer handle() const { return buffer_; }
  // After the device wrote it.
  const std::byte* read() const {
    const VkMappedMemoryRange all = {VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE, nullptr, memory_, 0,
                                     VK_WHOLE_SIZE};
    if (!(flags_ & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT))
      check(device_.InvalidateMappedMemoryRanges(device_.handle(), 1, &all),
            "vkInvalidateMappedMemoryRanges");
    return static_cast<const std::byte*>(mapped_);
  }

 private:
  void create(VkDeviceSize size) {
    VkBufferCreateInfo info = {};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = size;
    info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    check(device_.CreateBuffer(device_.handle(), &info, nullptr, &buffer_), "vkCreateBuffer");
    VkMemoryRequirements needed;
    device_.GetBufferMemoryRequirements(device_.handle(), buffer_, &needed);
    memory_ = device_.allocate(needed, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT,
                               VK_MEMORY_PROPERTY_HOST_CACHED_BIT, &flags_);
    check(device_.BindBufferMemory(device_.handle(), buffer_, memory_, 0), "vkBindBufferMemory");
    check(device_.MapMemory(device_.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &mapped_),
          "vkMapMemory");
  }
  void destroy() {
    device_.DestroyBuffer(device_.handle(), buffer_, nullptr);
    device_.FreeMemory(device_.handle(), memory_, nullptr);
  }

  const Device& device_;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkMemoryPropertyFlags flags_ = 0;
  void* mapped_ = nullptr;
};

void record_copy(const Device& device, VkCommandBuffer commands, const Swapchain& swapchain,
                 const XrSwapchainSubImage& sub, VkBuffer into) {
  VkImageMemoryBarrier barrier = {};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
  barrier.oldLayout = swapchain.layout();
  barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = swapchain.images[static_cast<size_t>(swapchain.last_released)].image;
  barrier.subresourceRange = {swapchain.aspect(), 0, 1, sub.imageArrayIndex, 1};
  device.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                            VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
  const auto& [offset, extent] = sub.imageRect;
  const VkBufferImageCopy region = {
      0,
      0,
      0,
      {swapchain.aspect(), 0, sub.imageArrayIndex, 1},
      {offset.x, offset.y, 0},
      {static_cast<uint32_t>(extent.width), static_cast<uint32_t>(extent.height), 1}};
  device.CmdCopyImageToBuffer(commands, barrier.image, barrier.newLayout, into, 1, &region);
  std::swap(barrier.oldLayout, barrier.newLayout);
  barrier.srcAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  device.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                            VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1,
                            &barrier);
  const VkBufferMemoryBarrier to_host = {VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER,
                                         nullptr,
                                         VK_ACCESS_TRANSFER_WRITE_BIT,
                                         VK_ACCESS_HOST_READ_BIT,
                                         VK_QUEUE_FAMILY_IGNORED,
                                         VK_QUEUE_FAMILY_IGNORED,
                                         into,
                                         0,
                                         VK_WHOLE_SIZE};
  device.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0,
                            0, nullptr, 1, &to_host, 0, nullptr);
}

// use(texel, i) for each texel of the rectangle, in rows from the top.
template <class Use>
void read_texels(const Device& device, const XrSwapchainSubImage& sub, const Use& use) {
  const Swapchain& swapchain = context().handles.find<Swapchain>(sub.swapchain, "swapchain");
  const size_t count = static_cast<size_t>(sub.imageRect.extent.width) *
                       static_cast<size_t>(sub.imageRect.extent.height);
  const HostBuffer buffer(device, count * swapchain.format.texel);
  device.submit([&](VkCommandBuffer commands) {
    record_copy(device, commands, swapchain, sub, buffer.handle());
  });
  const std::byte* texel = buffer.read();
  for (size_t i = 0; i < count; ++i, texel += swapchain.format.texel)
    use(swapchain.format, texel, i);
}

// From 0 at nearZ to 1 at farZ, as a perspective projection writes it. Either may be infinite,
// and nearZ the farther one.
float metres(double t, double near_z, double far_z) {
  const double inverse = (1 - t) / near_z + t / far_z;
  return inverse > 0 ? static_cast<float>(1 / inverse) : INFINITY;
}

}  // namespace

std::vector<uint8_t> read_colour(const Device& device, const XrSwapchainSubImage& sub) {
  const XrExtent2Di& extent = sub.imageRect.extent;
  std::vector<uint8_t> rgb(size_t{3} * static_cast<size_t>(extent.width) *
                           static_cast<size_t>(extent.height));
  read_texels(device, sub, [&](const Format& format, const std::byte* texel, size_t i) {
    const auto code = code_values(format, texel);
    std::memcpy(&rgb[3 * i], code.data(), code.size());
  });
  return rgb;
}

std::vector<float> read_depth(const Device& device, const XrCompositionLayerDepthInfoKHR& info,
                              XrExtent2Di& extent) {
  extent = info.subImage.imageRect.extent;
  std::vector<float> z(static_cast<size_t>(extent.width) * static_cast<size_t>(extent.height));
  const double span = double{info.maxDepth} - info.minDepth;
  read_texels(device, info.subImage, [&](const Format&, const std::byte* texel, size_t i) {
    float value;
    std::memcpy(&value, texel, sizeof value);
    z[i] = metres((value - info.minDepth) / span, info.nearZ, info.farZ);
  });
  return z;
}

}  // namespace test_runtime
