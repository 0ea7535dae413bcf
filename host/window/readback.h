#pragma once
// A frame's colour and depth, copied to where the host can read them.
#include "render_targets.h"

namespace host {

class Readback {
 public:
  Readback() = default;
  Readback(const Device& device, VkExtent2D extent, bool with_depth);

  void record(VkCommandBuffer commands, const RenderTargets& targets) const;
  // Once the commands are done.
  std::span<const uint8_t> rgba() const;
  std::span<const float> depth() const;  // as the buffer has it
  VkExtent2D extent() const { return extent_; }

 private:
  VkExtent2D extent_ = {0, 0};
  Buffer colour_, depth_;
};

}  // namespace host
