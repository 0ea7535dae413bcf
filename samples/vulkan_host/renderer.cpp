#include "renderer.h"

#include "render_pass.h"
#include "submission.h"

namespace host {

Renderer::Renderer(const Device& device, VoyagerLayer& voyager, VkFormat colour_format,
                   const DepthConvention& depth, const Mesh* mesh, const glm::dmat4& mesh_place,
                   bool half_rate)
    : device_(device),
      voyager_(voyager),
      colour_format_(colour_format),
      depth_(depth),
      mesh_place_(mesh_place),
      half_rate_(half_rate),
      passes_(device, colour_format),
      frames_(device) {
  if (mesh) meshes_.emplace(device, passes_.meshes(), colour_format, depth.encoding, *mesh);
  voyager_.create_composite(passes_.overlay(), colour_format, kDepthFormat);
}

void Renderer::resize(VkExtent2D extent) {
  device_.wait_idle();
  targets_ = {};
  targets_ = RenderTargets(device_, passes_, colour_format_, extent);
  voyager_.resize(extent);
  reuses_next_ = false;
}

void Renderer::draw(const Camera& camera, const Look& look, const Delivery& delivery) {
  wait_for_slot();
  const bool renders = look.composite != Composite::none && !reuses_next_;
  reuses_next_ = half_rate_ && renders;
  if (renders) {
    image_ = (image_ + 1) % kFramesInFlight;
    voyager_.begin_frame();
  }
  Submission before(record_before(camera, look, renders));
  if (renders) before.signal(voyager_.released(image_));
  frames_.submit_before(before, renders && voyager_.host_waits());

  if (renders) voyager_.render(camera, image_, look.composite == Composite::limit && look.mesh);

  Submission after(record_after(camera, look, renders, delivery));
  if (renders) after.wait(voyager_.rendered(image_), VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
  after.wait({delivery.wait}, VK_PIPELINE_STAGE_TRANSFER_BIT);
  after.signal({delivery.signal});
  frames_.submit_after(after);
}

void Renderer::record_meshes(VkCommandBuffer commands, const Camera& camera, bool mesh) const {
  begin_pass(commands, passes_.meshes(), targets_.meshes.get(), targets_.extent, {{0, 0, 0, 1}},
             static_cast<float>(depth_.far_plane()));
  if (mesh && meshes_)
    meshes_->record(commands, targets_.extent,
                    glm::mat4(clip_from_view(camera.frustum, depth_) *
                              view_from_world(camera.pose) * mesh_place_));
  vkCmdEndRenderPass(commands);
}

VkCommandBuffer Renderer::record_before(const Camera& camera, const Look& look, bool renders) {
  const VkCommandBuffer commands = frames_.begin_before();
  record_meshes(commands, camera, look.mesh);
  if (!renders) return commands;
  if (look.composite == Composite::limit && look.mesh)
    voyager_.record_depth_limit(commands, image_, {targets_.depth.image.get(), kDepthFormat});
  voyager_.record_release(commands, image_);
  return commands;
}

VkCommandBuffer Renderer::record_after(const Camera& camera, const Look& look, bool renders,
                                       const Delivery& delivery) {
  const VkCommandBuffer commands = frames_.begin_after();
  if (renders) voyager_.record_acquire(commands, image_);
  begin_pass(commands, passes_.overlay(), targets_.overlay.get(), targets_.extent, {}, 0);
  if (look.composite != Composite::none)
    voyager_.record_composite(
        commands, image_,
        look.composite == Composite::test ? VOY_VULKAN_DEPTH_USE_TEST : VOY_VULKAN_DEPTH_USE_WRITE,
        renders ? nullptr : &camera);
  if (delivery.overlay) delivery.overlay(commands);
  vkCmdEndRenderPass(commands);
  delivery.record(commands, targets_);
  return commands;
}

}  // namespace host
