#pragma once
// The host's colour and depth attachments and the two render passes over them: meshes, then
// what lies over them (Voyager's image, the HUD).
#include "device.h"
#include "resources.h"

namespace host {

inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

class RenderPasses {
 public:
  RenderPasses(const Device& device, VkFormat colour_format);

  // Clears both; leaves colour as an attachment, and depth in TRANSFER_SRC_OPTIMAL.
  VkRenderPass meshes() const { return meshes_.get(); }
  // Takes them so; leaves both in TRANSFER_SRC_OPTIMAL.
  VkRenderPass overlay() const { return overlay_.get(); }

 private:
  UniqueRenderPass meshes_, overlay_;
};

struct RenderTargets {
  RenderTargets() = default;
  RenderTargets(const Device& device, const RenderPasses& passes, VkFormat colour_format,
                VkExtent2D extent);

  VkExtent2D extent = {0, 0};
  Image colour, depth;
  UniqueFramebuffer meshes, overlay;
};

}  // namespace host
