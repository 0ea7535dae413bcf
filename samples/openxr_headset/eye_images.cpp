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

std::vector<VkExtent2D> recommended(const Runtime& runtime, const Graphics& graphics,
                                    VkExtent2D largest) {
  XrSystemProperties system = xr_struct<XrSystemProperties>(XR_TYPE_SYSTEM_PROPERTIES);
  check(xrGetSystemProperties(runtime.get(), runtime.system(), &system), "xrGetSystemProperties");
  const XrSystemGraphicsProperties& most = system.graphicsProperties;
  std::vector<VkExtent2D> out;
  for (const XrViewConfigurationView& view : runtime.views())
    out.push_back({clamped(view.recommendedImageRectWidth,
                           {view.maxImageRectWidth, most.maxSwapchainImageWidth,
                            graphics.largest_image(), largest.width}),
                   clamped(view.recommendedImageRectHeight,
                           {view.maxImageRectHeight, most.maxSwapchainImageHeight,
                            graphics.largest_image(), largest.height})});
  return out;
}

// Whether left and right are of one size, in each pair.
bool alike(const std::vector<EyeImage>& views) {
  for (size_t i = 0; i < views.size(); i += kEyes) {
    const VkExtent2D &left = views[i].extent, &right = views[i + 1].extent;
    if (left.width != right.width || left.height != right.height) return false;
  }
  return true;
}

}  // namespace

EyeImages::EyeImages(const Session& session, const Runtime& runtime, const Graphics& graphics,
                     VkExtent2D largest, bool readable) {
  const std::vector<int64_t> formats = session.swapchain_formats();
  for (const VkExtent2D& size : recommended(runtime, graphics, largest))
    views_.push_back({nullptr, nullptr, 0, size});
  create_colours(session, graphics, usable_colours(graphics, formats), readable);
  if (runtime.has_depth_layer()) create_depths(session, graphics, usable_depths(graphics, formats));
  for (size_t i = 0; i < views_.size(); ++i) {
    const size_t swapchain = array_ ? i / kEyes : i;
    views_[i].colour = &colours_[swapchain];
    views_[i].depth = depth_format_ ? &depths_[swapchain] : nullptr;
    views_[i].layer = array_ ? static_cast<uint32_t>(i % kEyes) : 0;
  }
}

std::vector<VkExtent2D> EyeImages::extents() const {
  std::vector<VkExtent2D> extents;
  for (const EyeImage& view : views_) extents.push_back(view.extent);
  return extents;
}

// The first that the runtime makes: the better format before the better layout.
void EyeImages::create_colours(const Session& session, const Graphics& graphics,
                               const std::vector<ColourFormat>& formats, bool readable) {
  SwapchainDesc desc = {
      {}, XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT, VK_IMAGE_ASPECT_COLOR_BIT, {}, 1};
  if (readable) desc.usage |= XR_SWAPCHAIN_USAGE_TRANSFER_SRC_BIT;
  std::string tried;
  for (const ColourFormat& format : formats) {
    colour_format_ = format;
    desc.format = format.format;
    for (const bool array : {true, false}) {
      array_ = array;
      if ((!array || alike(views_)) && create(session, graphics, desc, colours_)) return;
    }
    tried += (tried.empty() ? "" : ", ") + std::string(format.name);
  }
  throw Failure(kMachine, "swapchains: found none of " + tried +
                              (readable ? " that can be copied from" : "") + " (" + refusal_ +
                              "), expected one");
}

// The first that the runtime makes in the colours' layout; else there is no depth.
void EyeImages::create_depths(const Session& session, const Graphics& graphics,
                              const std::vector<VkFormat>& formats) {
  for (const VkFormat format : formats) {
    const SwapchainDesc desc = {
        format, XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, depth_aspects(format), {}, 1};
    if (!create(session, graphics, desc, depths_)) continue;
    depth_format_ = format;
    return;
  }
}

// False where the runtime refuses, whatever the error: each has its own for what it cannot do.
bool EyeImages::create(const Session& session, const Graphics& graphics, const SwapchainDesc& desc,
                       std::vector<Swapchain>& into) try {
  SwapchainDesc wanted = desc;
  wanted.layers = array_ ? kEyes : 1;
  into.clear();
  for (size_t i = 0; i < views_.size(); i += wanted.layers) {
    wanted.extent = views_[i].extent;
    into.emplace_back(session.get(), graphics, wanted);
  }
  return true;
} catch (const Failure& failure) {
  into.clear();
  refusal_ = failure.what();
  return false;
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
