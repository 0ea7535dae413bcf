#pragma once
// Render passes over a colour attachment, and one of depth where there is one.
#include "unique.h"

namespace host {

// Stored; without stencil.
VkAttachmentDescription attachment(VkFormat format, VkAttachmentLoadOp load, VkImageLayout before,
                                   VkImageLayout after);
// depth may be NULL. Before it: copies of the attachments and writes of a pass before. After it:
// copies, and the next pass.
UniqueRenderPass make_render_pass(VkDevice device, const VkAttachmentDescription& colour,
                                  const VkAttachmentDescription* depth);
// depth: NULL where the pass has none.
UniqueFramebuffer make_framebuffer(VkDevice device, VkRenderPass pass, VkExtent2D extent,
                                   VkImageView colour, VkImageView depth);
// On the whole framebuffer. A pass that loads ignores what it would be cleared to.
void begin_pass(VkCommandBuffer commands, VkRenderPass pass, VkFramebuffer framebuffer,
                VkExtent2D extent, const VkClearColorValue& colour, float depth);

}  // namespace host
