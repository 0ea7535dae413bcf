#pragma once
// Unity as a native plugin meets it, on a real Vulkan device: the interfaces, the order of the
// calls, and frames whose command buffers are cut and submitted when Unity would.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "../interop/vulkan_memory.h"
#include "plugin_api.h"

namespace voyager::test {

// What a RenderTexture's GetNativeTexturePtr stands for.
struct UnityTexture {
  HostImage image;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

struct UnityHabits {
  UnityGfxRenderer renderer = kUnityGfxRendererVulkan;
  bool has_v2 = true;
  bool loads_at_startup = true;    // else the device is there before the plugin
  bool submits_on_thread = false;  // AccessQueue calls back from another thread, at frame's end
  bool offers_extensions = true;   // else the driver has no extensions and no timelines
  bool chains_vulkan_1_2 = false;  // Unity asks for features of its own
  uint32_t api_version = VK_API_VERSION_1_2;
};

// What one camera draws in a frame.
struct UnityCameraEvent {
  UnityTexture* colour;
  UnityTexture* depth;  // or NULL
  float cleared_depth;
  void* data;  // for the plugin
};

// One at a time.
class ImitatedUnity {
 public:
  explicit ImitatedUnity(const UnityHabits& habits = {});
  // Shuts the graphics down and unloads the plugin. Expects no validation message.
  ~ImitatedUnity();
  ImitatedUnity(const ImitatedUnity&) = delete;
  ImitatedUnity& operator=(const ImitatedUnity&) = delete;

  bool has_device() const { return host_ && host_->exists(); }
  const VulkanHost& host() const { return *host_; }

  // The plugin's functions, as a script imports them.
  decltype(&voyUnityOpenScene) open_scene = nullptr;
  decltype(&voyUnityCamera) camera = nullptr;
  decltype(&voyUnityRenderEvent) render_event = nullptr;
  decltype(&voyUnityEventId) event_id = nullptr;
  decltype(&voyUnityStatistics) statistics = nullptr;
  std::string last_error() const;

  // Whether the device can have depth textures of that format.
  bool has_depth(VkFormat format) const;
  std::unique_ptr<UnityTexture> make_texture(VkFormat format, uint32_t width, uint32_t height);
  // A frame of Unity's: each camera's textures are cleared, then the plugin's event runs for it.
  void frame(const std::vector<UnityCameraEvent>& events);
  // Waits for all frames; the texture's bytes.
  std::vector<uint8_t> read(UnityTexture& texture);

 private:
  friend struct UnityTables;
  void load_plugin();
  void make_device();
  void cut();
  void clear(const UnityCameraEvent& event);
  void use(UnityTexture& texture, VkImageLayout layout);
  void run_queued();
  void finish(uint64_t frame);

  UnityHabits habits_;
  void* library_ = nullptr;
  decltype(&UnityPluginUnload) unload_ = nullptr;
  IUnityGraphicsDeviceEventCallback device_event_ = nullptr;
  UnityVulkanInitCallback intercept_ = nullptr;
  UnityVulkanPluginEventConfig config_ = {};
  std::unique_ptr<VulkanHost> host_;

  struct InFlight {
    uint64_t frame;
    VkFence fence;
    std::vector<VkCommandBuffer> commands;
  };
  std::vector<InFlight> in_flight_;
  std::vector<std::function<void()>> queued_;  // submissions and callbacks, in order
  std::vector<VkCommandBuffer> recorded_;      // of this frame
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  uint64_t frame_ = 0, safe_ = 0;
};

}  // namespace voyager::test
