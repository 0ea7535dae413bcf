#include "voyager_ring.h"

namespace host {

VoyagerRing::VoyagerRing(const Gpu& gpu, const voy::Device& device, const RingDesc& desc)
    : desc_(desc), queue_family_(gpu.queue_family), images_(desc.images) {
  VoyVulkanCapabilities modes = VOY_VULKAN_CAPABILITIES_INIT;
  VoyCapabilities capabilities = VOY_CAPABILITIES_INIT;
  capabilities.next = &modes;
  voy::check(voyGetCapabilities(device.get(), &capabilities));
  sync_ = modes.sync;
  VoyVulkanTargetDesc vulkan = VOY_VULKAN_TARGET_DESC_INIT;
  vulkan.imageCount = desc.images;
  vulkan.layerCount = desc.layers;
  vulkan.hasDepth = desc.depth;
  vulkan.hasDepthLimit = desc.depth_limit;
  VoyTargetDesc target = VOY_TARGET_DESC_INIT;
  target.next = &vulkan;
  target.kind = VOY_TARGET_KIND_VULKAN;
  target.width = desc.extent.width;
  target.height = desc.extent.height;
  target_ = device.create_target(target);
  uint32_t count = 0;
  voy::check(voyGetVulkanImages(target_.get(), desc.images, images_.data(), &count));
}

VoyVulkanUse VoyagerRing::use(VkCommandBuffer commands, uint32_t index) const {
  VoyVulkanUse use = VOY_VULKAN_USE_INIT;  // sampled in a fragment shader
  use.commandBuffer = commands;
  use.queueFamily = queue_family_;
  use.imageIndex = index;
  return use;
}

VoyVulkanFrame VoyagerRing::frame(uint32_t index) const {
  VoyVulkanFrame frame = VOY_VULKAN_FRAME_INIT;
  frame.imageIndex = index;
  frame.waitValue = frame.signalValue = sync_ == VOY_VULKAN_SYNC_BINARY ? 1 : timeline();
  return frame;
}

void VoyagerRing::record_release(VkCommandBuffer commands, uint32_t index) const {
  const VoyVulkanUse released = use(commands, index);
  voy::check(voyRecordVulkanRelease(target_.get(), &released));
}

void VoyagerRing::record_acquire(VkCommandBuffer commands, uint32_t index) const {
  const VoyVulkanUse acquired = use(commands, index);
  voy::check(voyRecordVulkanAcquire(target_.get(), &acquired));
}

}  // namespace host
