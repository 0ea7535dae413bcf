#include "tools/view/screen_pipeline.h"

#include "failure.h"
#include "graphics_states.h"
#include "screen.frag.h"
#include "screen.vert.h"

namespace voyager::view {
namespace {

using host::check;

struct Push {
  float split, exposure;
};

host::UniqueDescriptorSetLayout make_set_layout(VkDevice device) {
  VkDescriptorSetLayoutBinding bindings[2] = {};
  for (uint32_t i = 0; i < 2; ++i) {
    bindings[i].binding = i;
    bindings[i].descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    bindings[i].descriptorCount = 1;
    bindings[i].stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT;
  }
  VkDescriptorSetLayoutCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  info.bindingCount = 2;
  info.pBindings = bindings;
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  check(vkCreateDescriptorSetLayout(device, &info, nullptr, &layout),
        "vkCreateDescriptorSetLayout");
  return {device, layout};
}

host::UniquePipelineLayout make_layout(VkDevice device, VkDescriptorSetLayout set) {
  const VkPushConstantRange range = {VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(Push)};
  VkPipelineLayoutCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = 1;
  info.pSetLayouts = &set;
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &range;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  check(vkCreatePipelineLayout(device, &info, nullptr, &layout), "vkCreatePipelineLayout");
  return {device, layout};
}

host::UniqueDescriptorPool make_pool(VkDevice device) {
  const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 2 * host::kFramesInFlight};
  VkDescriptorPoolCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = host::kFramesInFlight;
  info.poolSizeCount = 1;
  info.pPoolSizes = &size;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(vkCreateDescriptorPool(device, &info, nullptr, &pool), "vkCreateDescriptorPool");
  return {device, pool};
}

bool is_srgb(VkFormat format) {
  return format == VK_FORMAT_R8G8B8A8_SRGB || format == VK_FORMAT_B8G8R8A8_SRGB;
}

host::UniquePipeline make_pipeline(VkDevice device, VkPipelineLayout layout, VkRenderPass pass,
                                   bool decode) {
  const host::UniqueShaderModule vertex = host::make_shader(device, screen_vert);
  const host::UniqueShaderModule fragment = host::make_shader(device, screen_frag);
  const VkBool32 decode_value = decode;
  const VkSpecializationMapEntry entry = {0, 0, sizeof decode_value};
  const VkSpecializationInfo constants = {1, &entry, sizeof decode_value, &decode_value};
  VkPipelineShaderStageCreateInfo stages[] = {
      host::shader_stage(VK_SHADER_STAGE_VERTEX_BIT, vertex),
      host::shader_stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};
  stages[1].pSpecializationInfo = &constants;
  const host::GraphicsStates states;
  VkGraphicsPipelineCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  info.stageCount = 2;
  info.pStages = stages;
  info.layout = layout;
  info.renderPass = pass;
  states.give_to(info);
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
        "vkCreateGraphicsPipelines");
  return {device, pipeline};
}

}  // namespace

ScreenPipeline::ScreenPipeline(const host::Gpu& gpu, VkRenderPass pass, VkFormat colour)
    : device_(gpu.device),
      set_layout_(make_set_layout(device_)),
      layout_(make_layout(device_, set_layout_.get())),
      pool_(make_pool(device_)),
      pipeline_(make_pipeline(device_, layout_.get(), pass, is_srgb(colour))) {
  for (VkDescriptorSet& set : sets_) {
    const VkDescriptorSetLayout layout = set_layout_.get();
    const VkDescriptorSetAllocateInfo info = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              nullptr, pool_.get(), 1, &layout};
    check(vkAllocateDescriptorSets(device_, &info, &set), "vkAllocateDescriptorSets");
  }
}

void ScreenPipeline::record(VkCommandBuffer commands, uint32_t slot, VkExtent2D extent,
                            const Screen& screen) {
  VkDescriptorImageInfo images[2] = {};
  images[0].imageView = screen.left;
  images[1].imageView = screen.right;
  for (VkDescriptorImageInfo& image : images)
    image.imageLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  VkWriteDescriptorSet write = {};
  write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
  write.dstSet = sets_[slot];
  write.descriptorCount = 2;  // goes on to the next binding
  write.descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  write.pImageInfo = images;
  vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
  const VkViewport viewport = {
      0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
  const VkRect2D scissor = {{0, 0}, extent};
  const Push push = {screen.split, screen.exposure};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.get());
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &scissor);
  vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push, &push);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1,
                          &sets_[slot], 0, nullptr);
  vkCmdDraw(commands, 3, 1, 0, 0);
}

}  // namespace voyager::view
