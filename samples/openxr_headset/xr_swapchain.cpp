#include "xr_swapchain.h"

namespace host {
namespace {

UniqueImageView make_view(VkDevice device, VkImage image, const SwapchainDesc& desc,
                          uint32_t layer) {
  VkImageViewCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  info.image = image;
  info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  info.format = desc.format;
  info.subresourceRange = {desc.aspects, 0, 1, layer, 1};
  VkImageView view = VK_NULL_HANDLE;
  check(vkCreateImageView(device, &info, nullptr, &view), "vkCreateImageView");
  return {device, view};
}

}  // namespace

Swapchain::Swapchain(XrSession session, const Graphics& graphics, const SwapchainDesc& desc)
    : extent_(desc.extent), layers_(desc.layers) {
  XrSwapchainCreateInfo info = xr_struct<XrSwapchainCreateInfo>(XR_TYPE_SWAPCHAIN_CREATE_INFO);
  info.usageFlags = desc.usage;
  info.format = desc.format;
  info.sampleCount = 1;
  info.width = desc.extent.width;
  info.height = desc.extent.height;
  info.faceCount = 1;
  info.arraySize = desc.layers;
  info.mipCount = 1;
  XrSwapchain made = XR_NULL_HANDLE;
  check(xrCreateSwapchain(session, &info, &made), "xrCreateSwapchain");
  swapchain_ = UniqueXrSwapchain(made);
  list_images(graphics, desc);
}

void Swapchain::list_images(const Graphics& graphics, const SwapchainDesc& desc) {
  const auto images =
      xr_list("xrEnumerateSwapchainImages",
              xr_struct<XrSwapchainImageVulkan2KHR>(XR_TYPE_SWAPCHAIN_IMAGE_VULKAN2_KHR),
              [&](uint32_t capacity, uint32_t* size, XrSwapchainImageVulkan2KHR* into) {
                return xrEnumerateSwapchainImages(
                    get(), capacity, size, reinterpret_cast<XrSwapchainImageBaseHeader*>(into));
              });
  for (const XrSwapchainImageVulkan2KHR& image : images) {
    images_.push_back(image.image);
    for (uint32_t layer = 0; layer < layers_; ++layer)
      views_.push_back(make_view(graphics.get(), image.image, desc, layer));
  }
}

bool Swapchain::ready(XrDuration patience) {
  if (state_ == State::released) {
    const auto info = xr_struct<XrSwapchainImageAcquireInfo>(XR_TYPE_SWAPCHAIN_IMAGE_ACQUIRE_INFO);
    check(xrAcquireSwapchainImage(get(), &info, &index_), "xrAcquireSwapchainImage");
    if (index_ >= images_.size())
      throw Failure(kMachine, "xrAcquireSwapchainImage: found image " + std::to_string(index_) +
                                  ", expected one of " + std::to_string(images_.size()));
    state_ = State::acquired;
  }
  if (state_ == State::acquired) {
    auto info = xr_struct<XrSwapchainImageWaitInfo>(XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO);
    info.timeout = patience;
    if (check(xrWaitSwapchainImage(get(), &info), "xrWaitSwapchainImage") == XR_TIMEOUT_EXPIRED)
      return false;
    state_ = State::ready;
  }
  return true;
}

void Swapchain::release() {
  const auto info = xr_struct<XrSwapchainImageReleaseInfo>(XR_TYPE_SWAPCHAIN_IMAGE_RELEASE_INFO);
  check(xrReleaseSwapchainImage(get(), &info), "xrReleaseSwapchainImage");
  state_ = State::released;
}

}  // namespace host
