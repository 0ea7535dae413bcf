#include "renderer.h"

#include "render_pass.h"
#include "submission.h"

namespace host {

Renderer::Renderer(const Device& device, VoyagerLayer& voyager, VkFormat colour_format,
                   const DepthConvention& depth, const Mesh* mesh, const glm::dmat4& mesh_place)
    : device_(device),
      voyager_(voyager),
      colour_format_(colour_format),
      depth_(depth),
      mesh_place_(mesh_place),
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
}

void Renderer::draw(const Camera& camera, const Look& look, const Delivery& delivery) {
  const uint32_t slot = wait_for_slot();
  const bool splats = look.composite != Composite::none;
  if (splats) voyager_.begin_frame();
  Submission before(record_before(slot, camera, look));
  if (splats) before.signal(voyager_.released(slot));
  frames_.submit_before(before, splats && voyager_.host_waits());

  if (splats) voyager_.render(camera, slot, look.composite == Composite::limit && look.mesh);

  Submission after(record_after(slot, look, delivery));
  if (splats) after.wait(voyager_.rendered(slot), VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
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

VkCommandBuffer Renderer::record_before(uint32_t slot, const Camera& camera, const Look& look) {
  const VkCommandBuffer commands = frames_.begin_before();
  record_meshes(commands, camera, look.mesh);
  if (look.composite == Composite::limit && look.mesh)
    voyager_.record_depth_limit(commands, slot, {targets_.depth.image.get(), kDepthFormat});
  if (look.composite != Composite::none) voyager_.record_release(commands, slot);
  return commands;
}

VkCommandBuffer Renderer::record_after(uint32_t slot, const Look& look, const Delivery& delivery) {
  const VkCommandBuffer commands = frames_.begin_after();
  const bool splats = look.composite != Composite::none;
  if (splats) voyager_.record_acquire(commands, slot);
  begin_pass(commands, passes_.overlay(), targets_.overlay.get(), targets_.extent, {}, 0);
  if (splats)
    voyager_.record_composite(
        commands, slot,
        look.composite == Composite::test ? VOY_VULKAN_DEPTH_USE_TEST : VOY_VULKAN_DEPTH_USE_WRITE);
  if (delivery.overlay) delivery.overlay(commands);
  vkCmdEndRenderPass(commands);
  delivery.record(commands, targets_);
  return commands;
}

}  // namespace host
