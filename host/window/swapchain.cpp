#include "swapchain.h"

#include <algorithm>

#include "failure.h"

namespace host {
namespace {

bool is_srgb(VkFormat format) {
  return format == VK_FORMAT_B8G8R8A8_SRGB || format == VK_FORMAT_R8G8B8A8_SRGB;
}

VkSurfaceFormatKHR choose_format(VkPhysicalDevice physical, VkSurfaceKHR surface) {
  uint32_t count = 0;
  check(vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface, &count, nullptr),
        "vkGetPhysicalDeviceSurfaceFormatsKHR");
  std::vector<VkSurfaceFormatKHR> formats(count);
  check(vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface, &count, formats.data()),
        "vkGetPhysicalDeviceSurfaceFormatsKHR");
  for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM,
                                VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R8G8B8A8_SRGB})
    for (const VkSurfaceFormatKHR& format : formats)
      if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR)
        return format;
  throw Failure(kMachine, "found no window format of 8 bits a channel, expected one");
}

UniqueSemaphore make_semaphore(VkDevice device) {
  VkSemaphoreCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
  VkSemaphore semaphore = VK_NULL_HANDLE;
  check(vkCreateSemaphore(device, &info, nullptr, &semaphore), "vkCreateSemaphore");
  return {device, semaphore};
}

// False where the window has changed. Other failures throw.
bool is_current(VkResult result, const char* call) {
  if (result == VK_ERROR_OUT_OF_DATE_KHR) return false;
  check(result, call);
  return true;
}

}  // namespace

Swapchain::Swapchain(const Device& device, VkSurfaceKHR surface)
    : device_(device), surface_(surface), format_(choose_format(device.physical(), surface)) {
  colour_format_ = is_srgb(format_.format) ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
  for (UniqueSemaphore& semaphore : acquired_) semaphore = make_semaphore(device.get());
}

bool Swapchain::resize(VkExtent2D wanted) {
  VkSurfaceCapabilitiesKHR surface;
  check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), surface_, &surface),
        "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
  if (!(surface.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT))
    throw Failure(kMachine, "found a window that cannot be copied to, expected one that can");
  extent_ = {
      std::clamp(wanted.width, surface.minImageExtent.width, surface.maxImageExtent.width),
      std::clamp(wanted.height, surface.minImageExtent.height, surface.maxImageExtent.height)};
  if (extent_.width == 0 || extent_.height == 0) return false;
  const uint32_t most = surface.maxImageCount ? surface.maxImageCount : UINT32_MAX;
  VkSwapchainCreateInfoKHR info = {};
  info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
  info.surface = surface_;
  info.minImageCount = std::min(surface.minImageCount + 1, most);
  info.imageFormat = format_.format;
  info.imageColorSpace = format_.colorSpace;
  info.imageExtent = extent_;
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  info.preTransform = surface.currentTransform;
  // The lowest bit that is there; OPAQUE is the lowest of all.
  info.compositeAlpha = static_cast<VkCompositeAlphaFlagBitsKHR>(
      surface.supportedCompositeAlpha & (~surface.supportedCompositeAlpha + 1));
  info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
  info.clipped = VK_TRUE;
  info.oldSwapchain = swapchain_.get();
  VkSwapchainKHR swapchain = VK_NULL_HANDLE;
  check(vkCreateSwapchainKHR(device_.get(), &info, nullptr, &swapchain), "vkCreateSwapchainKHR");
  swapchain_ = UniqueSwapchain(device_.get(), swapchain);

  uint32_t count = 0;
  check(vkGetSwapchainImagesKHR(device_.get(), swapchain, &count, nullptr),
        "vkGetSwapchainImagesKHR");
  images_.resize(count);
  check(vkGetSwapchainImagesKHR(device_.get(), swapchain, &count, images_.data()),
        "vkGetSwapchainImagesKHR");
  ready_.clear();
  for (uint32_t i = 0; i < count; ++i) ready_.push_back(make_semaphore(device_.get()));
  return true;
}

bool Swapchain::acquire(uint32_t slot) {
  return is_current(vkAcquireNextImageKHR(device_.get(), swapchain_.get(), UINT64_MAX,
                                          acquired_[slot].get(), VK_NULL_HANDLE, &image_),
                    "vkAcquireNextImageKHR");
}

void Swapchain::record(VkCommandBuffer commands, const RenderTargets& targets) const {
  VkImageMemoryBarrier barrier = {};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = images_[image_];
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0,
                       0, nullptr, 0, nullptr, 1, &barrier);
  const VkOffset3D corner = {static_cast<int32_t>(extent_.width),
                             static_cast<int32_t>(extent_.height), 1};
  const VkImageSubresourceLayers layers = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  const VkImageBlit region = {layers, {{0, 0, 0}, corner}, layers, {{0, 0, 0}, corner}};
  vkCmdBlitImage(commands, targets.colour.image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                 images_[image_], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region,
                 VK_FILTER_NEAREST);
  barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.dstAccessMask = 0;
  barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  barrier.newLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, 0, 0, nullptr, 0, nullptr, 1,
                       &barrier);
}

bool Swapchain::present() {
  const VkSemaphore ready = ready_[image_].get();
  const VkSwapchainKHR swapchain = swapchain_.get();
  VkPresentInfoKHR info = {};
  info.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
  info.waitSemaphoreCount = 1;
  info.pWaitSemaphores = &ready;
  info.swapchainCount = 1;
  info.pSwapchains = &swapchain;
  info.pImageIndices = &image_;
  return is_current(vkQueuePresentKHR(device_.queue(), &info), "vkQueuePresentKHR");
}

}  // namespace host
