#pragma once
// Pipelines that draw an image of a ring over the host's, in the host's render pass.
#include <memory>
#include <optional>

#include "runtime/math/host_depth.h"
#include "runtime/math/reprojection.h"
#include "vulkan_interop/composite_pipeline.h"
#include "vulkan_interop/ring.h"

namespace voyager::vulkan {

enum class DepthUse { none, test, write };

struct CompositeDraw {
  VkCommandBuffer commands = VK_NULL_HANDLE;
  VkRect2D area{};
  bool upside_down = false;  // the image's first row goes to the last row of `area`
  DepthUse depth_use = DepthUse::none;
  DepthEncoding encoding;  // of the attachment
  std::optional<Reprojection> reprojection;
};

class Composite {
 public:
  // Throws Error(unsupported) for attachments that the device cannot draw to like this.
  Composite(std::shared_ptr<const Device> device, const CompositeDesc& desc);

  // Throws Error(invalid_argument) where the ring or the attachment lacks what is asked for.
  void record(const Ring& ring, uint32_t index, uint32_t layer, const CompositeDraw& draw) const;

 private:
  struct Pipelines {
    Owned<VkPipeline> color, tested[2], depth_only[2];  // standard, reversed
  };
  void draw(const CompositeDraw& draw, VkPipeline pipeline) const;

  std::shared_ptr<const Device> device_;
  bool has_depth_;
  Owned<VkPipelineLayout> layout_;
  Pipelines as_drawn_, reprojected_;
};

}  // namespace voyager::vulkan
