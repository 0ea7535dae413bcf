#pragma once
// The images that Voyager draws into, and command buffers of the extension's own that copy them
// into Godot's textures. Godot's own command buffers cannot be recorded into, and are submitted at
// the end of the frame: what is submitted here in a render callback runs before all of them.
#include <voyager/voyager_vulkan.h>

#include <array>
#include <voyager/voyager.hpp>

#include "device_functions.h"

namespace voyager_godot {

// RGBA8 colour and R32F depth of one size. Both are in SHADER_READ_ONLY_OPTIMAL before and after,
// as Godot keeps textures that were created with data and are only sampled.
struct GodotTextures {
  VkImage colour, depth;
};

class SplatImages {
 public:
  // On the rendering thread. Throws voy::Error and std::runtime_error. `functions` must outlive it.
  SplatImages(const DeviceFunctions& functions, const voy::Device& device,
              const NativeDevice& native, VkExtent2D extent);
  // Waits until the GPU has finished its commands.
  ~SplatImages();
  SplatImages(const SplatImages&) = delete;
  SplatImages& operator=(const SplatImages&) = delete;

  VkExtent2D extent() const { return extent_; }
  VoyTarget target() const { return target_.get(); }
  // Draws `frame`, which lacks only its VoyVulkanFrame, and submits the copies. Waits where the GPU
  // is a whole ring behind. On the rendering thread. Throws voy::Error and std::runtime_error.
  void draw(voy::View& view, VoyFrame frame, const GodotTextures& into);

 private:
  static constexpr uint32_t kImages = 3;  // what Godot has in flight, and one more
  struct Slot {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;  // signalled while the GPU does not use the image
  };

  void create_slots();
  void destroy();
  VkCommandBuffer begin(uint32_t image);
  void submit(uint32_t image);
  void wait(uint32_t image) const;
  VoyVulkanUse use(uint32_t image) const;
  void record_copies(VkCommandBuffer commands, uint32_t image, const GodotTextures& into) const;

  const DeviceFunctions& functions_;
  const NativeDevice native_;
  VkExtent2D extent_;
  voy::Target target_;
  VoyVulkanImage images_[kImages] = {};
  VkCommandPool pool_ = VK_NULL_HANDLE;
  std::array<Slot, kImages> slots_;
  uint32_t next_ = 0;
};

}  // namespace voyager_godot
