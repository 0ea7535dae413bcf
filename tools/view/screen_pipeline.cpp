#include "tools/view/screen_pipeline.h"

#include "graphics_states.h"
#include "screen.frag.h"
#include "screen.vert.h"

namespace voyager::view {
namespace {

struct Push {
  float split, exposure;
};

constexpr VkPushConstantRange kConstants = {VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(Push)};

bool is_srgb(VkFormat format) {
  return format == VK_FORMAT_R8G8B8A8_SRGB || format == VK_FORMAT_B8G8R8A8_SRGB;
}

host::UniquePipeline make_screen_pipeline(VkDevice device, VkPipelineLayout layout,
                                          VkRenderPass pass, bool decode) {
  const host::UniqueShaderModule vertex = host::make_shader(device, screen_vert);
  const host::UniqueShaderModule fragment = host::make_shader(device, screen_frag);
  const VkBool32 decode_value = decode;
  const VkSpecializationMapEntry entry = {0, 0, sizeof decode_value};
  const VkSpecializationInfo constants = {1, &entry, sizeof decode_value, &decode_value};
  VkPipelineShaderStageCreateInfo stages[] = {
      host::shader_stage(VK_SHADER_STAGE_VERTEX_BIT, vertex),
      host::shader_stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};
  stages[1].pSpecializationInfo = &constants;
  return host::make_pipeline(device, stages, host::GraphicsStates(), layout, pass);
}

}  // namespace

ScreenPipeline::ScreenPipeline(const host::Gpu& gpu, VkRenderPass pass, VkFormat colour)
    : sets_(gpu.device, host::kFramesInFlight, 2),
      layout_(host::make_pipeline_layout(gpu.device, sets_.layout(), kConstants)),
      pipeline_(make_screen_pipeline(gpu.device, layout_.get(), pass, is_srgb(colour))) {}

void ScreenPipeline::record(VkCommandBuffer commands, uint32_t slot, VkExtent2D extent,
                            const Screen& screen) {
  const VkImageView views[] = {screen.left, screen.right};
  sets_.write(slot, views);
  const VkViewport viewport = {
      0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
  const VkRect2D scissor = {{0, 0}, extent};
  const Push push = {screen.split, screen.exposure};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.get());
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &scissor);
  vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push, &push);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1,
                          &sets_.set(slot), 0, nullptr);
  vkCmdDraw(commands, 3, 1, 0, 0);
}

}  // namespace voyager::view
