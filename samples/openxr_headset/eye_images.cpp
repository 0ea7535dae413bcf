#include "eye_images.h"

#include <algorithm>

namespace host {
namespace {

// Limits of 0 are none.
uint32_t clamped(uint32_t recommended, std::initializer_list<uint32_t> limits) {
  uint32_t side = std::max(recommended, 1u);
  for (const uint32_t limit : limits)
    if (limit > 0) side = std::min(side, limit);
  return side;
}

std::array<VkExtent2D, kEyes> recommended(const Runtime& runtime, const Graphics& graphics,
                                          VkExtent2D largest) {
  XrSystemProperties system = xr_struct<XrSystemProperties>(XR_TYPE_SYSTEM_PROPERTIES);
  check(xrGetSystemProperties(runtime.get(), runtime.system(), &system), "xrGetSystemProperties");
  const XrSystemGraphicsProperties& most = system.graphicsProperties;
  const std::vector<XrViewConfigurationView> views = runtime.views();
  std::array<VkExtent2D, kEyes> out = {};
  for (size_t i = 0; i < kEyes; ++i)
    out[i] = {clamped(views[i].recommendedImageRectWidth,
                      {views[i].maxImageRectWidth, most.maxSwapchainImageWidth,
                       graphics.largest_image(), largest.width}),
              clamped(views[i].recommendedImageRectHeight,
                      {views[i].maxImageRectHeight, most.maxSwapchainImageHeight,
                       graphics.largest_image(), largest.height})};
  return out;
}

}  // namespace

EyeImages::EyeImages(const Session& session, const Runtime& runtime, const Graphics& graphics,
                     VkExtent2D largest, bool readable) {
  const std::vector<int64_t> formats = session.swapchain_formats();
  colour_format_ = choose_colour(graphics, formats);
  const auto sizes = recommended(runtime, graphics, largest);
  for (size_t i = 0; i < kEyes; ++i) eyes_[i].extent = sizes[i];
  const bool same = sizes[0].width == sizes[1].width && sizes[0].height == sizes[1].height;

  SwapchainDesc desc = {colour_format_.format,
                        XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT,
                        VK_IMAGE_ASPECT_COLOR_BIT,
                        {},
                        1};
  if (readable) desc.usage |= XR_SWAPCHAIN_USAGE_TRANSFER_SRC_BIT;
  const bool array = same && create(session, graphics, true, desc, colours_);
  if (!array && !create(session, graphics, false, desc, colours_))
    throw Failure(kMachine, "xrCreateSwapchain: found none of " + std::string(colour_format_.name) +
                                (readable ? " that can be copied from" : "") + ", expected one");

  if (runtime.has_depth_layer()) depth_format_ = choose_depth(graphics, formats);
  if (depth_format_) {
    desc.format = *depth_format_;
    desc.usage = XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    desc.aspects = depth_aspects(*depth_format_);
    if (!create(session, graphics, array, desc, depths_)) depth_format_.reset();
  }
  for (size_t i = 0; i < kEyes; ++i) {
    eyes_[i].colour = &colours_[array ? 0 : i];
    eyes_[i].depth = depth_format_ ? &depths_[array ? 0 : i] : nullptr;
    eyes_[i].layer = array ? static_cast<uint32_t>(i) : 0;
  }
}

bool EyeImages::create(const Session& session, const Graphics& graphics, bool array,
                       const SwapchainDesc& desc, std::vector<Swapchain>& into) const {
  SwapchainDesc wanted = desc;
  wanted.layers = array ? kEyes : 1;
  into.clear();
  for (size_t i = 0; i < (array ? 1 : kEyes); ++i) {
    wanted.extent = eyes_[i].extent;
    std::optional<Swapchain> made = Swapchain::create(session.get(), graphics, wanted);
    if (!made) return false;
    into.push_back(std::move(*made));
  }
  return true;
}

bool EyeImages::ready(XrDuration patience) {
  for (std::vector<Swapchain>* swapchains : {&colours_, &depths_})
    for (Swapchain& swapchain : *swapchains)
      if (!swapchain.ready(patience)) return false;
  return true;
}

void EyeImages::release() {
  for (std::vector<Swapchain>* swapchains : {&colours_, &depths_})
    for (Swapchain& swapchain : *swapchains) swapchain.release();
}

}  // namespace host
