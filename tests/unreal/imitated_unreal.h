#pragma once
// Unreal as the module meets it, on a real Vulkan device: the RHI behind the stub, and frames whose
// passes are executed on another thread, as on Unreal's RHI thread.
#include <memory>
#include <string>
#include <vector>

#include "../interop/vulkan_memory.h"
#include "SceneView.h"
#include "ScreenPass.h"
#include "VoyagerModule.h"

// A texture of Unreal's, in the layout that it was used in last.
class FRHITexture {
 public:
  HostImage image;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

namespace voyager::test {

class ImitatedRhi;

struct UnrealHabits {
  bool draws_with_vulkan = true;
  bool enables_requested = true;  // else no extension, as an engine whose driver has none
};

// What a view draws in a frame.
struct UnrealView {
  FSceneView view;
  FRDGTexture* colour;
  FIntRect rect;  // of the colour texture
  FRDGTexture* depth;
  float cleared_depth = 0;
  FRDGTexture* override_output = nullptr;
};

// One at a time.
class ImitatedUnreal {
 public:
  explicit ImitatedUnreal(const UnrealHabits& habits = {});
  // Exits the engine and unloads the module. Expects no validation message.
  ~ImitatedUnreal();
  ImitatedUnreal(const ImitatedUnreal&) = delete;
  ImitatedUnreal& operator=(const ImitatedUnreal&) = delete;

  bool has_device() const { return host_ && host_->exists(); }
  IVoyagerModule& module() const { return IVoyagerModule::Get(); }
  std::string last_error() const;
  // What the module asked for before the device was there.
  const std::vector<std::string>& requested() const { return requested_; }
  const std::vector<std::string>& log() const { return log_; }

  std::unique_ptr<FRHITexture> make_texture(VkFormat format, uint32_t width, uint32_t height) const;
  // The textures are cleared, as the scene would be drawn, then the extensions draw.
  void frame(const UnrealView& view);
  // Waits for all frames; four bytes a pixel.
  std::vector<uint8_t> read(FRHITexture& texture);

 private:
  friend class ImitatedRhi;
  friend struct StubAccess;
  void use(FRHITexture& texture, VkImageLayout layout) const;
  void clear(const UnrealView& view) const;
  void execute(FRDGBuilder& builder, VkFence fence);
  void finish(size_t in_flight);

  UnrealHabits habits_;
  std::unique_ptr<VulkanHost> host_;
  std::unique_ptr<ImitatedRhi> rhi_;
  std::unique_ptr<IModuleInterface> module_;
  std::vector<std::string> requested_, log_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;

  struct InFlight {
    VkFence fence;
    VkCommandBuffer commands;
    std::vector<std::shared_ptr<void>> written;  // Unreal's fences
  };
  std::vector<InFlight> in_flight_;
};

}  // namespace voyager::test
