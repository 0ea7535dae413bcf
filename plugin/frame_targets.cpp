#include "plugin/frame_targets.h"

#include <algorithm>

#include "plugin/claim.h"
#include "plugin/structs.h"

namespace voyager {
namespace {

void check_size(const Image& image, const ViewObject& view, const FieldName& eye) {
  if (image.width > view.max_width || image.height > view.max_height)
    refuse(eye.str() + ".target: found " + std::to_string(image.width) + " x " +
           std::to_string(image.height) + " pixels, expected at most the view's " +
           std::to_string(view.max_width) + " x " + std::to_string(view.max_height));
}

EyeTarget checked_target(Call& call, const VoyFrameEye& eye, const ViewObject& view,
                         const FieldName& name) {
  EyeTarget out;
  check_structure(&eye, VOY_STRUCTURE_TYPE_FRAME_EYE, name,
                  Extension{VOY_STRUCTURE_TYPE_EYE_DEPTH_LIMIT, out.limit});
  out.object = call.use<TargetObject>(eye.target, name + ".target");
  if (out.object->parent() != view.parent())
    refuse(name.str() + ".target: found a target of another device, expected the view's");
  check_size(out.object->image, view, name);
  const uint32_t layers = out.object->ring == nullptr ? 1 : out.object->ring->desc().layers;
  check_count(eye.layer, 0, layers - 1, name + ".layer");
  out.layer = eye.layer;
  return out;
}

void check_other(const EyeTarget& target, const EyeTarget& before, const FieldName& name) {
  if ((target.object->ring == nullptr) != (before.object->ring == nullptr))
    refuse(name.str() +
           ".target: found a target of another kind than the first eye's, expected the same kind");
  if (target.object == before.object && target.layer == before.layer)
    refuse(name.str() + ": found the target and layer of the first eye, expected another image");
}

void check_vulkan(const EyeTarget& target, const VoyVulkanFrame* frame) {
  if (target.object->ring == nullptr) {
    if (frame != nullptr)
      throw ApiError(
          VOY_ERROR_INVALID_STRUCTURE,
          "frame.next: found a VoyVulkanFrame with a target of kind HOST_MEMORY, expected none");
    return;
  }
  if (frame == nullptr)
    refuse("frame.next: found no VoyVulkanFrame, expected one for a target of kind VULKAN");
  check_count(frame->imageIndex, 0, target.object->ring->desc().images - 1,
              "VoyVulkanFrame.imageIndex");
  check_count(frame->reserved, 0, 0, "VoyVulkanFrame.reserved");
}

// Rings that are gone make room for others.
void keep_ring(std::vector<std::weak_ptr<vulkan::Ring>>& rings,
               const std::shared_ptr<vulkan::Ring>& ring) {
  std::erase_if(rings, [&](const auto& kept) { return kept.expired() || kept.lock() == ring; });
  rings.push_back(ring);
}

void begin_eye(const EyeTarget& target, uint32_t image, const vulkan::FrameSync& sync,
               FrameEye& eye) {
  vulkan::Ring& ring = *target.object->ring;
  eye.image = ring.begin_frame(image, target.layer, sync);
  eye.depth_wanted = ring.desc().depth;
  if (target.limit == nullptr || eye.limits.values != nullptr) return;
  eye.image.external.limited = eye.image.external.ring != nullptr;
  ring.set_limits(image, target.layer, eye.limits);
}

}  // namespace

FieldName eye_name(size_t eye) {
  return {"frame.eyes", eye};
}

std::vector<EyeTarget> checked_targets(Call& call, const VoyFrame& frame,
                                       const VoyVulkanFrame* vulkan, const ViewObject& view) {
  std::vector<EyeTarget> targets;
  for (uint32_t eye = 0; eye < frame.eyeCount; ++eye) {
    targets.push_back(checked_target(call, frame.eyes[eye], view, eye_name(eye)));
    if (eye > 0) check_other(targets[eye], targets[0], eye_name(eye));
    check_vulkan(targets[eye], vulkan);
  }
  return targets;
}

std::vector<std::unique_lock<std::mutex>> claim(const std::vector<EyeTarget>& targets) {
  std::vector<std::unique_lock<std::mutex>> locks;
  for (size_t eye = 0; eye < targets.size(); ++eye)
    if (eye == 0 || targets[eye].object != targets[0].object)
      locks.push_back(claim_object(*targets[eye].object, eye_name(eye) + ".target"));
  return locks;
}

void render_into_rings(const std::vector<EyeTarget>& targets, const VoyVulkanFrame& vulkan,
                       ViewObject& view, FrameInput& frame) {
  const vulkan::FrameSync sync{vulkan.waitValue, vulkan.signalValue};
  for (size_t eye = 0; eye < targets.size(); ++eye) {
    keep_ring(view.rings, targets[eye].object->ring);
    begin_eye(targets[eye], vulkan.imageIndex, sync, frame.eyes[eye]);
  }
  view.view->render(frame);
  for (size_t eye = 0; eye < targets.size(); ++eye)
    if (eye == 0 || targets[eye].object != targets[0].object)
      targets[eye].object->ring->end_frame(sync);
}

}  // namespace voyager
