#include "render_targets.h"

#include "render_pass.h"

namespace host {

RenderPasses::RenderPasses(const Device& device, VkFormat colour_format) {
  constexpr VkImageLayout kColour = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  constexpr VkImageLayout kCopied = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  constexpr VkAttachmentLoadOp kClear = VK_ATTACHMENT_LOAD_OP_CLEAR;
  constexpr VkAttachmentLoadOp kLoad = VK_ATTACHMENT_LOAD_OP_LOAD;
  constexpr VkImageLayout kUnknown = VK_IMAGE_LAYOUT_UNDEFINED;
  const auto cleared_depth = attachment(kDepthFormat, kClear, kUnknown, kCopied);
  const auto kept_depth = attachment(kDepthFormat, kLoad, kCopied, kCopied);
  meshes_ = make_render_pass(device.get(), attachment(colour_format, kClear, kUnknown, kColour),
                             &cleared_depth);
  overlay_ = make_render_pass(device.get(), attachment(colour_format, kLoad, kColour, kCopied),
                              &kept_depth);
}

RenderTargets::RenderTargets(const Device& device, const RenderPasses& passes,
                             VkFormat colour_format, VkExtent2D size)
    : extent(size),
      colour(device, size, colour_format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
             VK_IMAGE_ASPECT_COLOR_BIT),
      depth(device, size, kDepthFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
            VK_IMAGE_ASPECT_DEPTH_BIT) {
  for (const auto& [framebuffer, pass] :
       {std::pair(&meshes, passes.meshes()), std::pair(&overlay, passes.overlay())})
    *framebuffer =
        make_framebuffer(device.get(), pass, extent, colour.view.get(), depth.view.get());
}

}  // namespace host
