#pragma once
// The render pass that fills a view's swapchain images from a layer of Voyager's: colour, and
// depth where the compositor takes it. Swapchain images come and go in the layouts of
// attachments, as XR_KHR_vulkan_enable2 has it.
#include <map>
#include <optional>

#include "camera.h"
#include "eye_images.h"
#include "sampled_images.h"
#include "visible_area.h"
#include "voyager_layer.h"

namespace host {

class EyePass {
 public:
  // voyager: sized, with depth exactly where `depth` is given.
  EyePass(const Graphics& graphics, VkFormat colour, std::optional<VkFormat> depth,
          const VoyagerLayer& voyager, const DepthConvention& convention);

  // Voyager's image of this slot is acquired, the view's images are ready.
  void record(VkCommandBuffer commands, uint32_t slot, size_t view, const EyeImage& image,
              const VisibleArea& area, const VoyFrustum& frustum);

 private:
  // Whatever pairs of images the two swapchains hand out.
  VkFramebuffer framebuffer(size_t view, const EyeImage& image);

  const Graphics& graphics_;
  const VoyagerLayer& voyager_;
  const DepthConvention convention_;
  UniqueRenderPass pass_;
  SampledImages sets_;  // slot by slot, view by view
  UniquePipelineLayout layout_;
  UniquePipeline pipeline_;
  std::map<std::array<size_t, 3>, UniqueFramebuffer> framebuffers_;
};

}  // namespace host
