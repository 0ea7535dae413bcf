#include "eye_pass.h"

#include "eye_pipeline.h"
#include "render_pass.h"

namespace host {
EyePass::EyePass(const Graphics& graphics, VkFormat colour, std::optional<VkFormat> depth,
                 const VoyagerLayer& voyager, const DepthConvention& convention)
    : graphics_(graphics),
      voyager_(voyager),
      convention_(convention),
      pass_(make_eye_render_pass(graphics.get(), colour, depth)),
      sets_(graphics.get(), kFramesInFlight * voyager.view_count(), depth ? 2 : 1),
      layout_(make_eye_layout(graphics.get(), sets_.layout())),
      pipeline_(make_eye_pipeline(graphics.get(), layout_.get(), pass_.get(), depth.has_value())) {
  for (uint32_t slot = 0; slot < kFramesInFlight; ++slot)
    for (size_t view = 0; view < voyager.view_count(); ++view) {
      const VoyVulkanImage& image = voyager.image(slot, view);
      const VkImageView views[] = {image.colorView, image.depthView};
      sets_.write(slot * voyager_.view_count() + view, std::span(views).first(depth ? 2 : 1));
    }
}

VkFramebuffer EyePass::framebuffer(size_t view, const EyeImage& image) {
  const bool depth = image.depth != nullptr;
  UniqueFramebuffer& made =
      framebuffers_[{view, image.colour->index(), depth ? image.depth->index() : 0}];
  if (made.get()) return made.get();
  made =
      make_framebuffer(graphics_.get(), pass_.get(), image.extent, image.colour->view(image.layer),
                       depth ? image.depth->view(image.layer) : VK_NULL_HANDLE);
  return made.get();
}

void EyePass::record(VkCommandBuffer commands, uint32_t slot, size_t view, const EyeImage& image,
                     const VisibleArea& area, const VoyFrustum& frustum) {
  // What is out of sight: black, and far away.
  begin_pass(commands, pass_.get(), framebuffer(view, image), image.extent, {{0, 0, 0, 1}},
             static_cast<float>(convention_.far_plane()));

  const VkViewport viewport = {
      0, 0, static_cast<float>(image.extent.width), static_cast<float>(image.extent.height), 0, 1};
  const VkRect2D scissor = {{0, 0}, image.extent};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.get());
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1,
                          &sets_.set(slot * voyager_.view_count() + view), 0, nullptr);
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &scissor);
  const ToClip clip = area.to_clip(frustum);
  const double range = convention_.far_z - convention_.near_z;
  const EyePush push = {{clip.scale[0], clip.scale[1]},
                        {clip.offset[0], clip.offset[1]},
                        static_cast<int32_t>(voyager_.layer(view)),
                        static_cast<float>(convention_.far_z / range),
                        static_cast<float>(-convention_.far_z * convention_.near_z / range)};
  vkCmdPushConstants(commands, layout_.get(),
                     VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push,
                     &push);
  area.record(commands);
  vkCmdEndRenderPass(commands);
}

}  // namespace host
