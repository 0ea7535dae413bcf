#pragma once
// How shaders see a ring's images: set 0, colour at binding 0, depth at binding 1, all layers.
#include <vector>

#include "vulkan_interop/resources.h"

namespace voyager::vulkan {

Owned<VkDescriptorSetLayout> make_ring_layout(const Device& device);

class RingDescriptors {
 public:
  RingDescriptors() = default;
  RingDescriptors(const Device& device, uint32_t images);

  // Views in SHADER_READ_ONLY_OPTIMAL; either may be none.
  void set(const Device& device, uint32_t image, VkImageView color, VkImageView depth);
  VkDescriptorSet of(uint32_t image) const { return sets_[image]; }

 private:
  Owned<VkDescriptorSetLayout> layout_;
  Owned<VkDescriptorPool> pool_;  // and its sets
  std::vector<VkDescriptorSet> sets_;
};

}  // namespace voyager::vulkan
