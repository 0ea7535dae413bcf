#pragma once
// VoyagerSplats, the class that scripts see. From the first frame until the object is freed it
// holds Voyager on Godot's device.
#include <voyager/voyager_vulkan.h>

#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <voyager/voyager.hpp>

#include "device_functions.h"
#include "godot_axes.h"
#include "native_handles.h"
#include "splat_images.h"

namespace voyager_godot {

// What a render callback passes.
struct SplatFrame {
  void* rendering_device;  // Godot's object, or NULL
  uint64_t colour, depth;  // RIDs of textures: RGBA8 and R32F
  VkExtent2D extent;       // of both
  Transform camera;        // RenderSceneData.get_cam_transform()
  Projection projection;   // RenderSceneData.get_cam_projection()
};

// On any thread, except draw().
class Splats {
 public:
  ~Splats();

  // Opens a scene in place of the one before: a file or a URL. Returns at once; the scene is opened
  // on a thread of its own once the first frame has come.
  void open_scene(const std::string& path);
  void close_scene();
  // On the rendering thread. False if the textures were not written: with an error, or because the
  // scene is not open yet.
  bool draw(const SplatFrame& frame);

  // Why the last scene or frame failed; "" if it did not. UTF-8.
  std::string last_error() const;
  // How pixels reach Godot's textures; "" before the first frame. UTF-8.
  std::string mode() const;

 private:
  bool draw_scene(const SplatFrame& frame);
  void create_device(const NativeDevice& native);
  bool take_opened_scene();
  void fit_view(VkExtent2D extent);
  void report(const char* error);

  mutable std::mutex mutex_;  // error_, mode_, path_ and wanted_
  std::string error_, mode_, path_;
  uint64_t wanted_ = 0;  // counts calls of open_scene and close_scene

  // What follows belongs to the rendering thread.
  std::unique_ptr<VulkanLoader> loader_;
  NativeDevice native_ = {};
  std::unique_ptr<DeviceFunctions> functions_;
  voy::Device device_;
  uint64_t begun_ = 0;  // the value of wanted_ that `opening_` or `scene_` is for
  std::future<voy::Scene> opening_;
  voy::Scene scene_;
  voy::View view_;
  VkExtent2D view_extent_ = {0, 0};
  std::unique_ptr<SplatImages> images_;
};

}  // namespace voyager_godot
