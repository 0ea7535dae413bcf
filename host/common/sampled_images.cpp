#include "sampled_images.h"

#include "failure.h"

namespace host {
namespace {

constexpr VkDescriptorType kType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;

UniqueDescriptorSetLayout make_layout(VkDevice device, uint32_t images) {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (uint32_t i = 0; i < images; ++i)
    bindings.push_back({i, kType, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr});
  VkDescriptorSetLayoutCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  info.bindingCount = images;
  info.pBindings = bindings.data();
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  check(vkCreateDescriptorSetLayout(device, &info, nullptr, &layout),
        "vkCreateDescriptorSetLayout");
  return {device, layout};
}

UniqueDescriptorPool make_pool(VkDevice device, uint32_t sets, uint32_t images) {
  const VkDescriptorPoolSize size = {kType, sets * images};
  VkDescriptorPoolCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = sets;
  info.poolSizeCount = 1;
  info.pPoolSizes = &size;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(vkCreateDescriptorPool(device, &info, nullptr, &pool), "vkCreateDescriptorPool");
  return {device, pool};
}

}  // namespace

SampledImages::SampledImages(VkDevice device, uint32_t sets, uint32_t images_in_set)
    : device_(device),
      layout_(make_layout(device, images_in_set)),
      pool_(make_pool(device, sets, images_in_set)),
      sets_(sets) {
  const std::vector<VkDescriptorSetLayout> layouts(sets, layout_.get());
  const VkDescriptorSetAllocateInfo info = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr,
                                            pool_.get(), sets, layouts.data()};
  check(vkAllocateDescriptorSets(device, &info, sets_.data()), "vkAllocateDescriptorSets");
}

void SampledImages::write(size_t set, std::span<const VkImageView> views) {
  std::vector<VkDescriptorImageInfo> images;
  for (const VkImageView view : views)
    images.push_back({VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
  VkWriteDescriptorSet write = {};
  write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
  write.dstSet = sets_[set];
  write.descriptorCount = static_cast<uint32_t>(images.size());  // on into the next bindings
  write.descriptorType = kType;
  write.pImageInfo = images.data();
  vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
}

}  // namespace host
