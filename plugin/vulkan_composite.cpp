#include <cmath>

#include "plugin/call.h"
#include "plugin/depth_limit.h"
#include "plugin/frame_input.h"
#include "plugin/structs.h"
#include "plugin/vulkan_target.h"

using namespace voyager;

namespace {

vulkan::CompositeDesc checked(const VoyVulkanCompositeDesc& desc) {
  if (desc.colorFormat == VK_FORMAT_UNDEFINED)
    refuse("desc.colorFormat: found UNDEFINED, expected the format of the attachment");
  return {desc.renderPass, desc.subpass, desc.colorFormat, desc.depthFormat};
}

vulkan::DepthUse depth_use_of(VoyVulkanDepthUse use) {
  switch (use) {
    case VOY_VULKAN_DEPTH_USE_TEST:
      return vulkan::DepthUse::test;
    case VOY_VULKAN_DEPTH_USE_WRITE:
      return vulkan::DepthUse::write;
    default:
      return vulkan::DepthUse::none;
  }
}

vulkan::CompositeDraw checked(const VoyVulkanCompositeDraw& draw, const vulkan::Ring& ring) {
  check_pointer(draw.commandBuffer, "draw.commandBuffer");
  check_count(draw.imageIndex, 0, ring.desc().images - 1, "draw.imageIndex");
  check_count(draw.layer, 0, ring.desc().layers - 1, "draw.layer");
  check_count(draw.reserved, 0, 0, "draw.reserved");
  check_enum(draw.depthUse, VOY_VULKAN_DEPTH_USE_WRITE, "draw.depthUse");
  const VkExtent2D& extent = draw.area.extent;
  if (draw.area.offset.x < 0 || draw.area.offset.y < 0 || extent.width == 0 || extent.height == 0 ||
      extent.width > ring.desc().width || extent.height > ring.desc().height ||
      int64_t{draw.area.offset.x} + extent.width > INT32_MAX ||
      int64_t{draw.area.offset.y} + extent.height > INT32_MAX)
    refuse("draw.area: found " + std::to_string(extent.width) + " x " +
           std::to_string(extent.height) + " pixels at " + std::to_string(draw.area.offset.x) +
           ", " + std::to_string(draw.area.offset.y) + ", expected up to the target's " +
           std::to_string(ring.desc().width) + " x " + std::to_string(ring.desc().height) +
           " inside the attachment");
  vulkan::CompositeDraw out;
  out.commands = draw.commandBuffer;
  out.area = draw.area;
  out.upside_down = draw.upsideDown != VK_FALSE;
  out.depth_use = depth_use_of(draw.depthUse);
  if (out.depth_use == vulkan::DepthUse::none) return out;
  out.encoding = checked_encoding(draw.depthEncoding, draw.nearZ, draw.farZ, "draw");
  if (out.encoding.form == DepthForm::metres)
    refuse("draw.depthEncoding: found METERS, expected STANDARD or REVERSED");
  return out;
}

}  // namespace

VoyResult VOY_CALL voyCreateVulkanComposite(VoyDevice device, const VoyVulkanCompositeDesc* desc,
                                            VoyVulkanComposite* composite) {
  return guarded("voyCreateVulkanComposite", [&](Call& call) {
    const auto owner = call.use<DeviceObject>(device);
    check_structure(desc, VOY_STRUCTURE_TYPE_VULKAN_COMPOSITE_DESC, "VoyVulkanCompositeDesc");
    check_pointer(composite, "composite");
    if (owner->vulkan == nullptr)
      throw ApiError(VOY_ERROR_UNSUPPORTED,
                     "device: found a device without a VoyVulkanDeviceDesc, expected one with it");
    const auto object = std::make_shared<CompositeObject>(owner, checked(*desc));
    *composite = static_cast<VoyVulkanComposite>(HandleTable::instance().insert(object));
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyDestroyVulkanComposite(VoyVulkanComposite composite) {
  return guarded("voyDestroyVulkanComposite", [&](Call& call) {
    call.remove<CompositeObject>(composite);
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyRecordVulkanComposite(VoyVulkanComposite composite,
                                            const VoyVulkanCompositeDraw* draw) {
  return guarded("voyRecordVulkanComposite", [&](Call& call) {
    const auto object = call.use<CompositeObject>(composite);
    const VoyVulkanReprojection* moved = nullptr;
    check_structure(draw, VOY_STRUCTURE_TYPE_VULKAN_COMPOSITE_DRAW, "VoyVulkanCompositeDraw",
                    Extension{VOY_STRUCTURE_TYPE_VULKAN_REPROJECTION, moved});
    const auto target = call.use<TargetObject>(draw->target, "draw.target");
    if (target->parent() != object->parent())
      refuse("draw.target: found a target of another device, expected the composite's");
    const vulkan::Ring& ring = vulkan_ring(*target);
    vulkan::CompositeDraw wanted = checked(*draw, ring);
    if (moved != nullptr)
      wanted.reprojection = reprojection(
          eye_view(moved->drawnPose, "draw.next.drawnPose", moved->drawnFrustum,
                   "draw.next.drawnFrustum"),
          eye_view(moved->pose, "draw.next.pose", moved->frustum, "draw.next.frustum"));
    object->composite.record(ring, draw->imageIndex, draw->layer, wanted);
    return VOY_SUCCESS;
  });
}
