#include "vulkan_interop/composite.h"

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
  int32_t last_row;  // of the area, where the image is drawn upside down; else -1
  alignas(16) Reprojection reprojection;
};
static_assert(sizeof(Push) <= 128);  // what every device has

constexpr VkShaderStageFlags kFragment = VK_SHADER_STAGE_FRAGMENT_BIT;

template <size_t N>
Owned<VkShaderModule> make_module(const Device& device, const uint32_t (&code)[N]) {
  const VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0,
                                      sizeof code, code};
  return make<VkShaderModule>(device, device.functions().CreateShaderModule,
                              device.functions().DestroyShaderModule, info, "vkCreateShaderModule");
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
                "desc.renderPass: found VK_NULL_HANDLE, expected a render pass: the device has "
                "neither VK_KHR_dynamic_rendering nor Vulkan 1.3");
  check_attachments(device_->physical(), desc);
  const Owned<VkDescriptorSetLayout> set = make_ring_layout(*device_);
  const VkDescriptorSetLayout sets[] = {set.get()};
  const VkPushConstantRange push{kFragment, 0, sizeof(Push)};
  const VkPipelineLayoutCreateInfo layout{
      VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, nullptr, 0, 1, sets, 1, &push};
  layout_ = make<VkPipelineLayout>(*device_, vk.CreatePipelineLayout, vk.DestroyPipelineLayout,
                                   layout, "vkCreatePipelineLayout");
  const auto vertex = make_module(*device_, composite_vert);
  const auto color = make_module(*device_, composite_color_frag);
  const auto depth = make_module(*device_, composite_depth_frag);
  for (Pipelines* pipelines : {&as_drawn_, &reprojected_}) {
    const bool moved = pipelines == &reprojected_;
    const auto make_pipeline = [&](VkShaderModule fragment, bool places_depth, bool draws_color,
                                   bool reversed) {
      return make_composite_pipeline(
          *device_, layout_.get(), desc,
          {vertex.get(), fragment, places_depth, draws_color, reversed, moved});
    };
    pipelines->color = make_pipeline(color.get(), false, true, false);
    for (const bool reversed : {false, true}) {
      if (!has_depth_) break;
      pipelines->tested[reversed] = make_pipeline(depth.get(), true, true, reversed);
      pipelines->depth_only[reversed] = make_pipeline(depth.get(), true, false, reversed);
    }
  }
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
    refuse("draw.depthUse: found TEST or WRITE for a target without depth, expected NONE");
  if (depth && !has_depth_)
    refuse("draw.depthUse: found TEST or WRITE for a composite without depthFormat, expected NONE");
  if (to.reprojection && image.depth_view == VK_NULL_HANDLE)
    refuse("draw.next: found a reprojection of a target without depth, expected one with depth");
  const DeviceFunctions& vk = device_->functions();
  const VkDescriptorSet set = ring.descriptors(index);
  vk.CmdBindDescriptorSets(to.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1, &set,
                           0, nullptr);
  const Push push{{to.area.offset.x, to.area.offset.y},
                  static_cast<int32_t>(layer),
                  to.encoding.slope,
                  to.encoding.inverse_far,
                  reversed ? 0.0f : 1.0f,
                  to.upside_down ? static_cast<int32_t>(to.area.extent.height) - 1 : -1,
                  to.reprojection.value_or(Reprojection{})};
  vk.CmdPushConstants(to.commands, layout_.get(), kFragment, 0, sizeof push, &push);
  const VkViewport viewport{static_cast<float>(to.area.offset.x),
                            static_cast<float>(to.area.offset.y),
                            static_cast<float>(to.area.extent.width),
                            static_cast<float>(to.area.extent.height),
                            0,
                            1};
  vk.CmdSetViewport(to.commands, 0, 1, &viewport);
  vk.CmdSetScissor(to.commands, 0, 1, &to.area);
  const Pipelines& pipelines = to.reprojection ? reprojected_ : as_drawn_;
  if (to.depth_use != DepthUse::test) draw(to, pipelines.color.get());
  if (to.depth_use == DepthUse::test) draw(to, pipelines.tested[reversed].get());
  if (to.depth_use == DepthUse::write) draw(to, pipelines.depth_only[reversed].get());
}

}  // namespace voyager::vulkan
