#include "vulkan_interop/composite.h"

#include <string>

#include "composite.vert.h"
#include "composite_color.frag.h"
#include "composite_depth.frag.h"
#include "runtime/base/error.h"

namespace voyager::vulkan {
namespace {

// As the shaders declare it.
struct Push {
  int32_t first[2];
  int32_t layer;
  float slope, inverse_far, far_code;
};

constexpr VkShaderStageFlags kFragment = VK_SHADER_STAGE_FRAGMENT_BIT;

template <size_t N>
Owned<VkShaderModule> make_module(const Device& device, const uint32_t (&code)[N]) {
  const VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0,
                                      sizeof code, code};
  return make<VkShaderModule>(device, device.functions().CreateShaderModule,
                              device.functions().DestroyShaderModule, info, "vkCreateShaderModule");
}

bool encodes(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_B8G8R8A8_SRGB:
    case VK_FORMAT_A8B8G8R8_SRGB_PACK32:
      return true;
    default:
      return false;
  }
}

// Premultiplied, over what is there.
constexpr VkPipelineColorBlendAttachmentState over(bool writes) {
  const VkColorComponentFlags all = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                                    VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
  return {VK_TRUE,
          VK_BLEND_FACTOR_ONE,
          VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
          VK_BLEND_OP_ADD,
          VK_BLEND_FACTOR_ONE,
          VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
          VK_BLEND_OP_ADD,
          writes ? all : VkColorComponentFlags{0}};
}

[[noreturn]] void refuse(const char* what) {
  throw Error(ErrorCode::invalid_argument, what);
}

}  // namespace

Composite::Composite(std::shared_ptr<const Device> device, const CompositeDesc& desc)
    : device_(std::move(device)), has_depth_(desc.depth != VK_FORMAT_UNDEFINED) {
  const DeviceFunctions& vk = device_->functions();
  if (desc.render_pass == VK_NULL_HANDLE && !device_->has_dynamic_rendering())
    throw Error(ErrorCode::unsupported,
                "desc.renderPass: found VK_NULL_HANDLE, expected a render pass: neither "
                "VK_KHR_dynamic_rendering nor Vulkan 1.3 is there");
  const Owned<VkDescriptorSetLayout> set = make_ring_layout(*device_);
  const VkDescriptorSetLayout sets[] = {set.get()};
  const VkPushConstantRange push{kFragment, 0, sizeof(Push)};
  const VkPipelineLayoutCreateInfo layout{
      VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, nullptr, 0, 1, sets, 1, &push};
  layout_ = make<VkPipelineLayout>(*device_, vk.CreatePipelineLayout, vk.DestroyPipelineLayout,
                                   layout, "vkCreatePipelineLayout");
  const Modules modules{make_module(*device_, composite_vert),
                        make_module(*device_, composite_color_frag),
                        make_module(*device_, composite_depth_frag)};
  color_ = make_pipeline(desc, modules, kColor, false);
  if (!has_depth_) return;
  for (const bool reversed : {false, true}) {
    tested_[reversed] = make_pipeline(desc, modules, kTested, reversed);
    depth_only_[reversed] = make_pipeline(desc, modules, kDepthOnly, reversed);
  }
}

Owned<VkPipeline> Composite::make_pipeline(const CompositeDesc& desc, const Modules& modules,
                                           Kind kind, bool reversed) const {
  const VkBool32 choices[] = {encodes(desc.color), kind == kDepthOnly};
  const VkSpecializationMapEntry entries[] = {{0, 0, sizeof(VkBool32)},
                                              {1, sizeof(VkBool32), sizeof(VkBool32)}};
  const VkSpecializationInfo special{kind == kColor ? 1u : 2u, entries, sizeof choices, choices};
  const auto stage = [](VkShaderStageFlagBits at, VkShaderModule module,
                        const VkSpecializationInfo* info) {
    return VkPipelineShaderStageCreateInfo{
        VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, at, module, "main", info};
  };
  const VkPipelineShaderStageCreateInfo stages[] = {
      stage(VK_SHADER_STAGE_VERTEX_BIT, modules.vertex.get(), nullptr),
      stage(VK_SHADER_STAGE_FRAGMENT_BIT,
            kind == kColor ? modules.color.get() : modules.depth.get(), &special)};
  VkPipelineVertexInputStateCreateInfo input{};
  input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
  VkPipelineInputAssemblyStateCreateInfo assembly{};
  assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineViewportStateCreateInfo viewport{};
  viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{};
  raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
  raster.lineWidth = 1;
  VkPipelineMultisampleStateCreateInfo samples{};
  samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineDepthStencilStateCreateInfo depth{};
  depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
  depth.depthTestEnable = depth.depthWriteEnable = kind != kColor;
  depth.depthCompareOp = reversed ? VK_COMPARE_OP_GREATER_OR_EQUAL : VK_COMPARE_OP_LESS_OR_EQUAL;
  const VkPipelineColorBlendAttachmentState attachment = over(kind != kDepthOnly);
  VkPipelineColorBlendStateCreateInfo blend{};
  blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
  blend.attachmentCount = 1;
  blend.pAttachments = &attachment;
  const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  const VkPipelineDynamicStateCreateInfo dynamic{
      VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO, nullptr, 0, 2, states};
  VkPipelineRenderingCreateInfo rendering{};
  rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachmentFormats = &desc.color;
  rendering.depthAttachmentFormat = desc.depth;

  VkGraphicsPipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  info.pNext = desc.render_pass == VK_NULL_HANDLE ? &rendering : nullptr;
  info.stageCount = 2;
  info.pStages = stages;
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic;
  info.layout = layout_.get();
  info.renderPass = desc.render_pass;
  info.subpass = desc.subpass;
  const DeviceFunctions& vk = device_->functions();
  const auto create = [&](VkDevice owner, const VkGraphicsPipelineCreateInfo* made,
                          const VkAllocationCallbacks* callbacks, VkPipeline* pipeline) {
    return vk.CreateGraphicsPipelines(owner, VK_NULL_HANDLE, 1, made, callbacks, pipeline);
  };
  return make<VkPipeline>(*device_, create, vk.DestroyPipeline, info, "vkCreateGraphicsPipelines");
}

void Composite::draw(const CompositeDraw& draw, VkPipeline pipeline) const {
  const DeviceFunctions& vk = device_->functions();
  vk.CmdBindPipeline(draw.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  vk.CmdDraw(draw.commands, 3, 1, 0, 0);
}

void Composite::record(const Ring& ring, uint32_t index, uint32_t layer,
                       const CompositeDraw& to) const {
  const RingImage image = ring.image(index);
  const bool depth = to.depth_use != DepthUse::none;
  const bool reversed = to.encoding.form == DepthForm::reversed;
  if (image.color_view == VK_NULL_HANDLE)
    refuse(
        "draw.target: found an image that cannot be sampled, expected colour with "
        "VK_IMAGE_USAGE_SAMPLED_BIT");
  if (depth && image.depth_view == VK_NULL_HANDLE)
    refuse("draw.depthUse: found one with depth for a target without, expected NONE");
  if (depth && !has_depth_)
    refuse(
        "draw.depthUse: found one with depth for a composite without depthFormat, expected NONE");
  const DeviceFunctions& vk = device_->functions();
  const VkDescriptorSet set = ring.descriptors(index);
  vk.CmdBindDescriptorSets(to.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1, &set,
                           0, nullptr);
  const Push push{{to.area.offset.x, to.area.offset.y},
                  static_cast<int32_t>(layer),
                  to.encoding.slope,
                  to.encoding.inverse_far,
                  reversed ? 0.0f : 1.0f};
  vk.CmdPushConstants(to.commands, layout_.get(), kFragment, 0, sizeof push, &push);
  const VkViewport viewport{static_cast<float>(to.area.offset.x),
                            static_cast<float>(to.area.offset.y),
                            static_cast<float>(to.area.extent.width),
                            static_cast<float>(to.area.extent.height),
                            0,
                            1};
  vk.CmdSetViewport(to.commands, 0, 1, &viewport);
  vk.CmdSetScissor(to.commands, 0, 1, &to.area);
  if (to.depth_use != DepthUse::test) draw(to, color_.get());
  if (to.depth_use == DepthUse::test) draw(to, tested_[reversed].get());
  if (to.depth_use == DepthUse::write) draw(to, depth_only_[reversed].get());
}

}  // namespace voyager::vulkan
