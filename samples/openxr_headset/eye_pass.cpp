#include "eye_pass.h"

#include "eye_pipeline.h"

namespace host {
namespace {

UniqueDescriptorPool make_pool(VkDevice device) {
  const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 2 * kEyes * kFramesInFlight};
  VkDescriptorPoolCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = kEyes * kFramesInFlight;
  info.poolSizeCount = 1;
  info.pPoolSizes = &size;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(vkCreateDescriptorPool(device, &info, nullptr, &pool), "vkCreateDescriptorPool");
  return {device, pool};
}

VkDescriptorSet make_set(VkDevice device, VkDescriptorPool pool, VkDescriptorSetLayout layout,
                         const VoyVulkanImage& image, bool depth) {
  VkDescriptorSetAllocateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  info.descriptorPool = pool;
  info.descriptorSetCount = 1;
  info.pSetLayouts = &layout;
  VkDescriptorSet set = VK_NULL_HANDLE;
  check(vkAllocateDescriptorSets(device, &info, &set), "vkAllocateDescriptorSets");
  constexpr VkImageLayout kLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  const VkDescriptorImageInfo images[] = {{VK_NULL_HANDLE, image.colorView, kLayout},
                                          {VK_NULL_HANDLE, image.depthView, kLayout}};
  VkWriteDescriptorSet write = {};
  write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
  write.dstSet = set;
  write.descriptorCount = depth ? 2 : 1;  // on into the next binding
  write.descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  write.pImageInfo = images;
  vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
  return set;
}

}  // namespace

EyePass::EyePass(const Graphics& graphics, VkFormat colour, std::optional<VkFormat> depth,
                 const VoyagerLayer& voyager, const DepthConvention& convention)
    : graphics_(graphics),
      voyager_(voyager),
      convention_(convention),
      pass_(make_eye_render_pass(graphics.get(), colour, depth)),
      set_layout_(make_eye_set_layout(graphics.get(), depth.has_value())),
      layout_(make_eye_layout(graphics.get(), set_layout_.get())),
      pipeline_(make_eye_pipeline(graphics.get(), layout_.get(), pass_.get(), depth.has_value())),
      pool_(make_pool(graphics.get())) {
  for (uint32_t slot = 0; slot < kFramesInFlight; ++slot)
    for (size_t eye = 0; eye < kEyes; ++eye)
      sets_[slot][eye] = make_set(graphics.get(), pool_.get(), set_layout_.get(),
                                  voyager.image(slot, eye), depth.has_value());
}

VkFramebuffer EyePass::framebuffer(size_t eye, const EyeImage& image) {
  const bool depth = image.depth != nullptr;
  UniqueFramebuffer& made =
      framebuffers_[{eye, image.colour->index(), depth ? image.depth->index() : 0}];
  if (made.get()) return made.get();
  const VkImageView views[] = {image.colour->view(image.layer),
                               depth ? image.depth->view(image.layer) : VK_NULL_HANDLE};
  VkFramebufferCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
  info.renderPass = pass_.get();
  info.attachmentCount = depth ? 2 : 1;
  info.pAttachments = views;
  info.width = image.extent.width;
  info.height = image.extent.height;
  info.layers = 1;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  check(vkCreateFramebuffer(graphics_.get(), &info, nullptr, &framebuffer), "vkCreateFramebuffer");
  made = {graphics_.get(), framebuffer};
  return framebuffer;
}

void EyePass::record(VkCommandBuffer commands, uint32_t slot, size_t eye, const EyeImage& image,
                     const VisibleArea& area, const VoyFrustum& frustum) {
  VkClearValue clear[2] = {};  // what is out of sight: black, and far away
  clear[0].color = {{0, 0, 0, 1}};
  clear[1].depthStencil = {static_cast<float>(convention_.far_plane()), 0};
  VkRenderPassBeginInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
  info.renderPass = pass_.get();
  info.framebuffer = framebuffer(eye, image);
  info.renderArea.extent = image.extent;
  info.clearValueCount = image.depth ? 2 : 1;
  info.pClearValues = clear;
  vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);

  const VkViewport viewport = {
      0, 0, static_cast<float>(image.extent.width), static_cast<float>(image.extent.height), 0, 1};
  const VkRect2D scissor = {{0, 0}, image.extent};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.get());
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1,
                          &sets_[slot][eye], 0, nullptr);
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &scissor);
  const ToClip clip = area.to_clip(frustum);
  const double range = convention_.far_z - convention_.near_z;
  const EyePush push = {{clip.scale[0], clip.scale[1]},
                        {clip.offset[0], clip.offset[1]},
                        static_cast<int32_t>(voyager_.layer(eye)),
                        static_cast<float>(convention_.far_z / range),
                        static_cast<float>(-convention_.far_z * convention_.near_z / range)};
  vkCmdPushConstants(commands, layout_.get(),
                     VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push,
                     &push);
  area.record(commands);
  vkCmdEndRenderPass(commands);
}

}  // namespace host
