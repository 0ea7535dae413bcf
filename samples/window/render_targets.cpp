#include "render_targets.h"

#include "failure.h"

namespace host {
namespace {

constexpr VkPipelineStageFlags kTests =
    VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
constexpr VkPipelineStageFlags kAttachments =
    VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | kTests;
constexpr VkAccessFlags kAttachmentWrites =
    VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
constexpr VkAccessFlags kAttachmentAccesses = kAttachmentWrites |
                                              VK_ACCESS_COLOR_ATTACHMENT_READ_BIT |
                                              VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;

VkAttachmentDescription attachment(VkFormat format, VkAttachmentLoadOp load, VkImageLayout before,
                                   VkImageLayout after) {
  VkAttachmentDescription description = {};
  description.format = format;
  description.samples = VK_SAMPLE_COUNT_1_BIT;
  description.loadOp = load;
  description.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  description.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  description.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  description.initialLayout = before;
  description.finalLayout = after;
  return description;
}

// Before: copies of the last frame, or of the depth, and writes of the pass before. After:
// copies, and the next pass.
UniqueRenderPass make_pass(VkDevice device, const VkAttachmentDescription (&attachments)[2]) {
  const VkAttachmentReference colour = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  const VkAttachmentReference depth = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass = {};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &colour;
  subpass.pDepthStencilAttachment = &depth;
  const VkPipelineStageFlags outside = kAttachments | VK_PIPELINE_STAGE_TRANSFER_BIT;
  const VkSubpassDependency dependencies[] = {
      {VK_SUBPASS_EXTERNAL, 0, outside, kAttachments, kAttachmentWrites, kAttachmentAccesses, 0},
      {0, VK_SUBPASS_EXTERNAL, kAttachments, outside, kAttachmentWrites,
       kAttachmentAccesses | VK_ACCESS_TRANSFER_READ_BIT, 0}};
  VkRenderPassCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
  info.attachmentCount = 2;
  info.pAttachments = attachments;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  info.dependencyCount = 2;
  info.pDependencies = dependencies;
  VkRenderPass pass = VK_NULL_HANDLE;
  check(vkCreateRenderPass(device, &info, nullptr, &pass), "vkCreateRenderPass");
  return {device, pass};
}

UniqueFramebuffer make_framebuffer(VkDevice device, VkRenderPass pass,
                                   const RenderTargets& targets) {
  const VkImageView views[] = {targets.colour.view.get(), targets.depth.view.get()};
  VkFramebufferCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
  info.renderPass = pass;
  info.attachmentCount = 2;
  info.pAttachments = views;
  info.width = targets.extent.width;
  info.height = targets.extent.height;
  info.layers = 1;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  check(vkCreateFramebuffer(device, &info, nullptr, &framebuffer), "vkCreateFramebuffer");
  return {device, framebuffer};
}

}  // namespace

RenderPasses::RenderPasses(const Device& device, VkFormat colour_format) {
  constexpr VkImageLayout kColour = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  constexpr VkImageLayout kCopied = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  constexpr VkAttachmentLoadOp kClear = VK_ATTACHMENT_LOAD_OP_CLEAR;
  constexpr VkAttachmentLoadOp kLoad = VK_ATTACHMENT_LOAD_OP_LOAD;
  meshes_ = make_pass(device.get(),
                      {attachment(colour_format, kClear, VK_IMAGE_LAYOUT_UNDEFINED, kColour),
                       attachment(kDepthFormat, kClear, VK_IMAGE_LAYOUT_UNDEFINED, kCopied)});
  overlay_ = make_pass(device.get(), {attachment(colour_format, kLoad, kColour, kCopied),
                                      attachment(kDepthFormat, kLoad, kCopied, kCopied)});
}

RenderTargets::RenderTargets(const Device& device, const RenderPasses& passes,
                             VkFormat colour_format, VkExtent2D size)
    : extent(size),
      colour(device, size, colour_format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
             VK_IMAGE_ASPECT_COLOR_BIT),
      depth(device, size, kDepthFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
            VK_IMAGE_ASPECT_DEPTH_BIT) {
  meshes = make_framebuffer(device.get(), passes.meshes(), *this);
  overlay = make_framebuffer(device.get(), passes.overlay(), *this);
}

}  // namespace host
