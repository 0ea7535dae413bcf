#include "composite_pass.h"

namespace voyager_unity {

Attachments::Attachments(const DeviceFunctions& functions, VkRenderPass pass,
                         const UnityVulkanImage& colour, const UnityVulkanImage* depth)
    : functions_(functions) {
  try {
    views_[0] = view_of(colour);
    if (depth) views_[1] = view_of(*depth);
    VkFramebufferCreateInfo info = {};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = pass;
    info.attachmentCount = depth ? 2 : 1;
    info.pAttachments = views_;
    info.width = colour.extent.width;
    info.height = colour.extent.height;
    info.layers = 1;
    check(functions_.create_framebuffer(functions_.device, &info, nullptr, &framebuffer_),
          "vkCreateFramebuffer");
  } catch (...) {
    destroy();
    throw;
  }
}

Attachments::~Attachments() {
  destroy();
}

void Attachments::destroy() {
  functions_.destroy_framebuffer(functions_.device, framebuffer_, nullptr);
  for (const VkImageView view : views_)
    functions_.destroy_image_view(functions_.device, view, nullptr);
}

VkImageView Attachments::view_of(const UnityVulkanImage& image) {
  VkImageViewCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  info.image = image.image;
  info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  info.format = image.format;
  info.subresourceRange = {image.aspect, 0, 1, 0, 1};
  VkImageView view = VK_NULL_HANDLE;
  check(functions_.create_image_view(functions_.device, &info, nullptr, &view),
        "vkCreateImageView");
  return view;
}

CompositePass::CompositePass(const DeviceFunctions& functions, const voy::Device& device,
                             VkFormat colour, VkFormat depth)
    : functions_(functions), colour_(colour), depth_(depth) {
  create_render_pass();
  VoyVulkanCompositeDesc desc = VOY_VULKAN_COMPOSITE_DESC_INIT;
  desc.renderPass = pass_;
  desc.colorFormat = colour;
  desc.depthFormat = depth;
  VoyVulkanComposite composite = nullptr;
  const VoyResult result = voyCreateVulkanComposite(device.get(), &desc, &composite);
  if (result < 0) functions_.destroy_render_pass(functions_.device, pass_, nullptr);
  voy::check(result);
  composite_ = decltype(composite_)(composite);
}

CompositePass::~CompositePass() {
  composite_ = {};
  functions_.destroy_render_pass(functions_.device, pass_, nullptr);
}

void CompositePass::create_render_pass() {
  const auto attachment = [](VkFormat format, VkImageLayout layout) {
    return VkAttachmentDescription{0,
                                   format,
                                   VK_SAMPLE_COUNT_1_BIT,
                                   VK_ATTACHMENT_LOAD_OP_LOAD,
                                   VK_ATTACHMENT_STORE_OP_STORE,
                                   VK_ATTACHMENT_LOAD_OP_LOAD,
                                   VK_ATTACHMENT_STORE_OP_STORE,
                                   layout,
                                   layout};
  };
  const VkAttachmentDescription attachments[] = {
      attachment(colour_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL),
      attachment(depth_, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL)};
  const VkAttachmentReference colour = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  const VkAttachmentReference depth = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass = {};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &colour;
  if (depth_ != VK_FORMAT_UNDEFINED) subpass.pDepthStencilAttachment = &depth;
  VkRenderPassCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
  info.attachmentCount = depth_ != VK_FORMAT_UNDEFINED ? 2 : 1;
  info.pAttachments = attachments;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  check(functions_.create_render_pass(functions_.device, &info, nullptr, &pass_),
        "vkCreateRenderPass");
}

std::shared_ptr<Attachments> CompositePass::record(VkCommandBuffer commands,
                                                   const UnityVulkanImage& colour,
                                                   const UnityVulkanImage* depth,
                                                   VoyVulkanCompositeDraw draw) const {
  auto attachments = std::make_shared<Attachments>(functions_, pass_, colour, depth);
  VkRenderPassBeginInfo begin = {};
  begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
  begin.renderPass = pass_;
  begin.framebuffer = attachments->framebuffer();
  begin.renderArea = {{0, 0}, {colour.extent.width, colour.extent.height}};
  draw.commandBuffer = commands;
  functions_.begin_render_pass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
  const VoyResult result = voyRecordVulkanComposite(composite_.get(), &draw);
  functions_.end_render_pass(commands);
  voy::check(result);
  return attachments;
}

}  // namespace voyager_unity
