#pragma once
// Every view's swapchain image as code values, copied to where the host can read them.
#include <span>

#include "eye_images.h"
#include "resources.h"

namespace host {

class Readback {
 public:
  // Throws Failure where images of this format cannot be copied so.
  Readback(const Graphics& graphics, const EyeImages& images);

  // After the render passes; leaves the swapchain images in the layout of attachments.
  void record(VkCommandBuffer commands, const EyeImages& images) const;
  // Once the commands are done.
  std::span<const uint8_t> rgba(size_t view) const;
  VkExtent2D extent(size_t view) const { return views_[view].extent; }

 private:
  // Linear light is encoded on the way, by a blit into an _SRGB image.
  struct View {
    VkExtent2D extent = {0, 0};
    Image encoded;
    Buffer buffer;
  };
  std::vector<View> views_;
};

}  // namespace host
