#include "vulkan_interop/ring_descriptors.h"

namespace voyager::vulkan {
namespace {

constexpr uint32_t kBindings = 2;

}  // namespace

Owned<VkDescriptorSetLayout> make_ring_layout(const Device& device) {
  VkDescriptorSetLayoutBinding bindings[kBindings] = {};
  for (uint32_t i = 0; i < kBindings; ++i)
    bindings[i] = {i, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
  const VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                             nullptr, 0, kBindings, bindings};
  return make<VkDescriptorSetLayout>(device, device.functions().CreateDescriptorSetLayout,
                                     device.functions().DestroyDescriptorSetLayout, info,
                                     "vkCreateDescriptorSetLayout");
}

RingDescriptors::RingDescriptors(const Device& device, uint32_t images)
    : layout_(make_ring_layout(device)), sets_(images) {
  const DeviceFunctions& vk = device.functions();
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, kBindings * images};
  const VkDescriptorPoolCreateInfo pool{
      VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, nullptr, 0, images, 1, &size};
  pool_ = make<VkDescriptorPool>(device, vk.CreateDescriptorPool, vk.DestroyDescriptorPool, pool,
                                 "vkCreateDescriptorPool");
  const std::vector<VkDescriptorSetLayout> layouts(images, layout_.get());
  const VkDescriptorSetAllocateInfo sets{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr,
                                         pool_.get(), images, layouts.data()};
  check(vk.AllocateDescriptorSets(device.handle(), &sets, sets_.data()),
        "vkAllocateDescriptorSets");
}

void RingDescriptors::set(const Device& device, uint32_t image, VkImageView color,
                          VkImageView depth) {
  VkDescriptorImageInfo views[kBindings];
  VkWriteDescriptorSet writes[kBindings];
  uint32_t count = 0, binding = 0;
  for (const VkImageView view : {color, depth}) {
    const uint32_t at = binding++;
    if (view == VK_NULL_HANDLE) continue;
    views[count] = {VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    writes[count] = {};
    writes[count].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[count].dstSet = sets_[image];
    writes[count].dstBinding = at;
    writes[count].descriptorCount = 1;
    writes[count].descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    writes[count].pImageInfo = &views[count];
    ++count;
  }
  device.functions().UpdateDescriptorSets(device.handle(), count, writes, 0, nullptr);
}

}  // namespace voyager::vulkan
