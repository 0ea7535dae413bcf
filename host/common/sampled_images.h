#pragma once
// Descriptor sets of the images that a fragment shader samples: bindings 0 and on.
#include <span>
#include <vector>

#include "unique.h"

namespace host {

class SampledImages {
 public:
  SampledImages(VkDevice device, uint32_t sets, uint32_t images_in_set);

  VkDescriptorSetLayout layout() const { return layout_.get(); }
  const VkDescriptorSet& set(size_t index) const { return sets_[index]; }
  // As many views as a set has, in SHADER_READ_ONLY_OPTIMAL when they are sampled. No frame that
  // samples from the set may be in flight.
  void write(size_t set, std::span<const VkImageView> views);

 private:
  VkDevice device_;
  UniqueDescriptorSetLayout layout_;
  UniqueDescriptorPool pool_;
  std::vector<VkDescriptorSet> sets_;
};

}  // namespace host
