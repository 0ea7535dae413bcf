// Commands that a target's ring, or a composite, records into the host's command buffers.
#include <cmath>

#include "plugin/call.h"
#include "plugin/claim.h"
#include "plugin/structs.h"
#include "plugin/vulkan_target.h"

using namespace voyager;

namespace {

void check_commands(VkCommandBuffer commands) {
  check_pointer(commands, "commandBuffer");
}

void check_layer(const vulkan::Ring& ring, uint32_t image, uint32_t layer) {
  check_count(image, 0, ring.desc().images - 1, "imageIndex");
  check_count(layer, 0, ring.desc().layers - 1, "layer");
}

void check_layout(VkImageLayout found, VkImageLayout usual, const char* field) {
  if (found != usual && found != VK_IMAGE_LAYOUT_GENERAL)
    refuse(std::string(field) + ": found VkImageLayout " + std::to_string(found) + ", expected " +
           std::to_string(usual) + " or GENERAL");
}

vulkan::Use use_of(const VoyVulkanUse& use) {
  check_commands(use.commandBuffer);
  if (use.layout != VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)
    check_layout(use.layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, "use.layout");
  if (use.stages == 0)
    refuse("use.stages: found 0, expected the stages of the host's commands that use the image");
  return {use.commandBuffer, use.queueFamily, use.layout, use.stages};
}

template <class Record>
VoyResult record_use(const char* function, VoyTarget target, const VoyVulkanUse* use,
                     const Record& record) {
  return guarded(function, [&](Call& call) {
    const auto object = call.use<TargetObject>(target);
    check_structure(use, VOY_STRUCTURE_TYPE_VULKAN_USE, "VoyVulkanUse");
    vulkan::Ring& ring = vulkan_ring(*object);
    check_layer(ring, use->imageIndex, 0);
    const vulkan::Use wanted = use_of(*use);
    const auto lock = claim_object(*object, "target");
    record(ring, wanted);
    return VOY_SUCCESS;
  });
}

// Of the target's rectangle in an image of the host's.
void check_offset(const VkOffset2D& offset, const vulkan::RingDesc& target, const char* field) {
  const auto fits = [](int32_t first, uint32_t size) {
    return first >= 0 && int64_t{first} + size <= INT32_MAX;
  };
  if (!fits(offset.x, target.width) || !fits(offset.y, target.height))
    refuse(std::string(field) + ": found " + std::to_string(offset.x) + ", " +
           std::to_string(offset.y) + ", expected an offset of 0 or more, from which " +
           std::to_string(target.width) + " x " + std::to_string(target.height) +
           " pixels lie within the image");
}

}  // namespace

VoyResult VOY_CALL voyRecordVulkanRelease(VoyTarget target, const VoyVulkanUse* use) {
  return record_use("voyRecordVulkanRelease", target, use,
                    [&](vulkan::Ring& ring, const vulkan::Use& wanted) {
                      ring.record_release(use->imageIndex, wanted);
                    });
}

VoyResult VOY_CALL voyRecordVulkanAcquire(VoyTarget target, const VoyVulkanUse* use) {
  return record_use("voyRecordVulkanAcquire", target, use,
                    [&](vulkan::Ring& ring, const vulkan::Use& wanted) {
                      ring.record_acquire(use->imageIndex, wanted);
                    });
}

VoyResult VOY_CALL voyRecordVulkanCopy(VoyTarget target, const VoyVulkanCopy* copy) {
  return guarded("voyRecordVulkanCopy", [&](Call& call) {
    const auto object = call.use<TargetObject>(target);
    check_structure(copy, VOY_STRUCTURE_TYPE_VULKAN_COPY, "VoyVulkanCopy");
    const vulkan::Ring& ring = vulkan_ring(*object);
    check_commands(copy->commandBuffer);
    check_layer(ring, copy->imageIndex, copy->layer);
    check_pointer(copy->into, "copy.into");
    check_layout(copy->layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, "copy.layout");
    check_layout(copy->intoLayout, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, "copy.intoLayout");
    check_offset(copy->intoOffset, ring.desc(), "copy.intoOffset");
    ring.record_copy(copy->imageIndex, copy->layer,
                     {copy->commandBuffer, copy->layout, copy->into, copy->intoFormat,
                      copy->intoLayout, copy->intoLayer, copy->intoOffset});
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyRecordVulkanDepthLimit(VoyTarget target, const VoyVulkanDepthLimit* limit) {
  return guarded("voyRecordVulkanDepthLimit", [&](Call& call) {
    const auto object = call.use<TargetObject>(target);
    check_structure(limit, VOY_STRUCTURE_TYPE_VULKAN_DEPTH_LIMIT, "VoyVulkanDepthLimit");
    const vulkan::Ring& ring = vulkan_ring(*object);
    check_commands(limit->commandBuffer);
    check_layer(ring, limit->imageIndex, limit->layer);
    check_pointer(limit->depth, "limit.depth");
    check_layout(limit->depthLayout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, "limit.depthLayout");
    check_offset(limit->depthOffset, ring.desc(), "limit.depthOffset");
    if (!ring.desc().depth_limit)
      refuse(
          "target: found a target without hasDepthLimit, expected "
          "VoyVulkanTargetDesc.hasDepthLimit");
    ring.record_depth_limit(
        limit->imageIndex, limit->layer,
        {limit->commandBuffer, limit->queueFamily, limit->depth, limit->depthFormat,
         limit->depthLayout, limit->depthLayer, limit->depthOffset});
    return VOY_SUCCESS;
  });
}
