#include "swapchain.h"

#include <algorithm>

namespace test_runtime {
namespace {

VkImageUsageFlags usage_of(const XrSwapchainCreateInfo& info, const Format& format) {
  // Only the usages that were asked for, and two that the runtime itself needs: attachment, because
  // it hands out images in that layout, and transfer source, because it captures pictures.
  VkImageUsageFlags usage = format.depth ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
                                         : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  if (!run().script.output.empty()) usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  const std::pair<XrSwapchainUsageFlags, VkImageUsageFlags> pairs[] = {
      {XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT},
      {XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
       VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT},
      {XR_SWAPCHAIN_USAGE_UNORDERED_ACCESS_BIT, VK_IMAGE_USAGE_STORAGE_BIT},
      {XR_SWAPCHAIN_USAGE_TRANSFER_SRC_BIT, VK_IMAGE_USAGE_TRANSFER_SRC_BIT},
      {XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT, VK_IMAGE_USAGE_TRANSFER_DST_BIT},
      {XR_SWAPCHAIN_USAGE_SAMPLED_BIT, VK_IMAGE_USAGE_SAMPLED_BIT}};
  for (const auto& [xr, vk] : pairs)
    if (info.usageFlags & xr) usage |= vk;
  return usage;
}

VkImageCreateInfo image_info(const XrSwapchainCreateInfo& info, const Format& format) {
  VkImageCreateInfo image = {};
  image.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  image.flags = info.usageFlags & XR_SWAPCHAIN_USAGE_MUTABLE_FORMAT_BIT
                    ? VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT
                    : 0;
  image.imageType = VK_IMAGE_TYPE_2D;
  image.format = format.format;
  image.extent = {info.width, info.height, 1};
  image.mipLevels = info.mipCount;
  image.arrayLayers = info.arraySize;
  image.samples = VK_SAMPLE_COUNT_1_BIT;
  image.tiling = VK_IMAGE_TILING_OPTIMAL;
  image.usage = usage_of(info, format);
  image.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
  image.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  return image;
}

void check_supported(const Device& device, const VkImageCreateInfo& image, const Format& format) {
  VkImageFormatProperties limits;
  const VkResult result = device.GetPhysicalDeviceImageFormatProperties(
      device.physical(), image.format, image.imageType, image.tiling, image.usage, image.flags,
      &limits);
  if (result != VK_SUCCESS || image.extent.width > limits.maxExtent.width ||
      image.extent.height > limits.maxExtent.height || image.mipLevels > limits.maxMipLevels ||
      image.arrayLayers > limits.maxArrayLayers)
    refuse(XR_ERROR_FEATURE_UNSUPPORTED,
           std::string("the device has no such image of ") + format.name + " with that use");
}

}  // namespace

Swapchain::Swapchain(Session& of, const XrSwapchainCreateInfo& create, const Format& of_format)
    : Object(&of), session(of), info(create), format(of_format) {
  check_supported(session.device, image_info(info, format), format);
  const bool fixed = info.createFlags & XR_SWAPCHAIN_CREATE_STATIC_IMAGE_BIT;
  images.resize(fixed ? 1 : static_cast<size_t>(run().script.images));
  try {
    for (SwapchainImage& image : images) create_image(image);
  } catch (...) {
    destroy_images();
    throw;
  }
}

Swapchain::~Swapchain() {
  destroy_images();
}

void Swapchain::destroy_images() {
  for (const SwapchainImage& image : images) {
    session.device.DestroyImage(session.device.handle(), image.image, nullptr);
    session.device.FreeMemory(session.device.handle(), image.memory, nullptr);
  }
}

void Swapchain::create_image(SwapchainImage& image) const {
  const Device& device = session.device;
  const VkImageCreateInfo create = image_info(info, format);
  check(device.CreateImage(device.handle(), &create, nullptr, &image.image), "vkCreateImage");
  VkMemoryRequirements needed;
  device.GetImageMemoryRequirements(device.handle(), image.image, &needed);
  image.memory = device.allocate(needed, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  check(device.BindImageMemory(device.handle(), image.image, image.memory, 0), "vkBindImageMemory");
}

VkImageLayout Swapchain::layout() const {
  return format.depth ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL
                      : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
}

VkImageAspectFlags Swapchain::aspect() const {
  return format.depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

void Swapchain::initialise(SwapchainImage& image) const {
  if (image.initialised || !run().script.image_layouts) return;
  session.device.submit([&](VkCommandBuffer commands) {
    const VkImageMemoryBarrier barrier = {
        VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        nullptr,
        0,
        VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
        VK_IMAGE_LAYOUT_UNDEFINED,
        layout(),
        VK_QUEUE_FAMILY_IGNORED,
        VK_QUEUE_FAMILY_IGNORED,
        image.image,
        {aspect(), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS}};
    session.device.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                      VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr,
                                      1, &barrier);
  });
  image.initialised = true;
}

uint32_t Swapchain::next_image() {
  std::vector<uint32_t> free;  // in the order in which they would be handed out
  const auto count = static_cast<uint32_t>(images.size());
  for (uint32_t i = 0; i < count; ++i) {
    const auto turn = static_cast<uint32_t>((acquisitions + i) % count);
    const uint32_t index =
        run().script.image_order == ImageOrder::descending ? count - 1 - turn : turn;
    // The displayed image comes last, below: it is handed out only if no other image is free.
    if (!images[index].acquired && (count == 1 || index != last_released)) free.push_back(index);
  }
  if (free.empty() && last_released >= 0 && !images[static_cast<size_t>(last_released)].acquired)
    free.push_back(static_cast<uint32_t>(last_released));
  if (free.empty())
    violation(XR_ERROR_CALL_ORDER_INVALID, "found every image acquired, expected a release before");
  size_t pick = 0;
  if (run().script.image_order == ImageOrder::shuffled)
    pick = static_cast<size_t>(acquisitions * 2654435761 >> 7) % free.size();
  if (session.swap_next_image) pick = (pick + 1) % free.size();
  session.swap_next_image = false;
  return free[pick];
}

Swapchain& find_swapchain(XrSwapchain handle) {
  Swapchain& swapchain = context().handles.find<Swapchain>(handle, "swapchain");
  check_not_lost(swapchain.session);
  return swapchain;
}

}  // namespace test_runtime
