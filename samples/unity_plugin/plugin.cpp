// The entry points. One process has one Unity, so the state is global.
#include "plugin_api.h"

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

#include "splat_renderer.h"
#include "unity_axes.h"
#include "vulkan_creation.h"

namespace voyager_unity {
namespace {

struct Plugin {
  IUnityInterfaces* interfaces = nullptr;
  IUnityGraphics* graphics = nullptr;
  int event_id = 0;
  std::mutex mutex;  // what follows
  std::shared_ptr<SplatRenderer> renderer;
  std::string absent;  // why there is no renderer
  std::string error;
  std::array<CameraFrame, 16> cameras = {};  // more than Unity queues
  size_t next_camera = 0;
};
Plugin plugin;

void report(const std::string& error) {
  const std::lock_guard lock(plugin.mutex);
  plugin.error = error;
}

// No exception may reach Unity. False if the function threw; what it threw is then the last error.
template <class Function>
bool guarded(Function&& function) {
  try {
    function();
    return true;
  } catch (const std::exception& error) {
    report(error.what());
    return false;
  }
}

std::shared_ptr<SplatRenderer> renderer() {
  const std::lock_guard lock(plugin.mutex);
  return plugin.renderer;
}

std::shared_ptr<SplatRenderer> existing_renderer() {
  const std::lock_guard lock(plugin.mutex);
  if (!plugin.renderer) throw std::runtime_error(plugin.absent);
  return plugin.renderer;
}

void configure_event(const IUnityGraphicsVulkan& vulkan) {
  UnityVulkanPluginEventConfig config = {};
  config.renderPassPrecondition = kUnityVulkanRenderPass_EnsureOutside;
  config.graphicsQueueAccess = kUnityVulkanGraphicsQueueAccess_DontCare;
  config.flags = kUnityVulkanEventConfigFlag_EnsurePreviousFrameSubmission |
                 kUnityVulkanEventConfigFlag_ModifiesCommandBuffersState;
  vulkan.ConfigureEvent(plugin.event_id, &config);
}

void initialize() {
  if (plugin.graphics->GetRenderer() == kUnityGfxRendererNull) return;  // the device comes later
  auto* vulkan = plugin.interfaces->Get<IUnityGraphicsVulkan>();
  if (plugin.graphics->GetRenderer() != kUnityGfxRendererVulkan || !vulkan)
    throw std::runtime_error("found another graphics API, expected Vulkan (Player Settings)");
  VoyVulkanDeviceDesc desc;
  if (!describe(vulkan->Instance(), &desc))
    throw std::runtime_error(
        "found a Vulkan device that the plugin has not seen made, expected Unity to load the "
        "plugin first (Load on startup, in its import settings)");
  configure_event(*vulkan);
  auto made = std::make_shared<SplatRenderer>(*vulkan, desc);
  const std::lock_guard lock(plugin.mutex);
  plugin.renderer = std::move(made);
}

void shut_down() {
  std::shared_ptr<SplatRenderer> last;
  const std::lock_guard lock(plugin.mutex);
  last.swap(plugin.renderer);
}

void UNITY_INTERFACE_API on_device_event(UnityGfxDeviceEventType event) {
  if (event == kUnityGfxDeviceEventInitialize && !guarded(initialize)) {
    const std::lock_guard lock(plugin.mutex);
    plugin.absent = plugin.error;
  }
  if (event == kUnityGfxDeviceEventShutdown) shut_down();
}

void UNITY_INTERFACE_API on_render_event(int, void* data) {
  guarded([&] {
    const std::shared_ptr<SplatRenderer> found = renderer();
    if (!found || !data) return;  // the device event has said why
    CameraFrame frame;
    {
      const std::lock_guard lock(plugin.mutex);
      frame = *static_cast<const CameraFrame*>(data);
    }
    found->draw(frame);
  });
}

// Where Unity refuses, initialize() finds that the device was not seen.
void intercept() {
  if (auto* newer = plugin.interfaces->Get<IUnityGraphicsVulkanV2>())
    newer->AddInterceptInitialization(intercept_creation, nullptr, 0);
  else if (auto* vulkan = plugin.interfaces->Get<IUnityGraphicsVulkan>())
    vulkan->InterceptInitialization(intercept_creation, nullptr);
}

}  // namespace
}  // namespace voyager_unity

using namespace voyager_unity;

void UNITY_INTERFACE_API UnityPluginLoad(IUnityInterfaces* interfaces) {
  plugin.interfaces = interfaces;
  plugin.absent = "found no graphics device, expected Unity to have made one";
  plugin.error.clear();
  plugin.graphics = interfaces->Get<IUnityGraphics>();
  plugin.event_id = plugin.graphics->ReserveEventIDRange(1);
  intercept();
  plugin.graphics->RegisterDeviceEventCallback(on_device_event);
  on_device_event(kUnityGfxDeviceEventInitialize);  // which is past if the plugin comes late
}

void UNITY_INTERFACE_API UnityPluginUnload() {
  plugin.graphics->UnregisterDeviceEventCallback(on_device_event);
  shut_down();
  forget_device();
}

int UNITY_INTERFACE_API voyUnityOpenScene(const char* path) {
  return guarded([&] { existing_renderer()->open_scene(path); });
}

void UNITY_INTERFACE_API voyUnityCloseScene() {
  if (const auto found = renderer()) found->close_scene();
}

void* UNITY_INTERFACE_API voyUnityCamera(const float* camera_to_world, const float* projection,
                                         float near_z, float far_z, void* colour, void* depth) {
  CameraFrame* camera = nullptr;
  guarded([&] {
    float world[16], lens[16];
    std::copy(camera_to_world, camera_to_world + 16, world);
    std::copy(projection, projection + 16, lens);
    const CameraFrame frame = {scene_pose(world), frustum(lens), near_z, far_z, colour, depth};
    const std::lock_guard lock(plugin.mutex);
    camera = &plugin.cameras[plugin.next_camera++ % plugin.cameras.size()];
    *camera = frame;
  });
  return camera;
}

UnityRenderingEventAndData UNITY_INTERFACE_API voyUnityRenderEvent() {
  return on_render_event;
}

int UNITY_INTERFACE_API voyUnityEventId() {
  return plugin.event_id;
}

int UNITY_INTERFACE_API voyUnityStatistics(VoyUnityStats* stats) {
  return guarded([&] {
    const VoyFrameStats all = existing_renderer()->stats();
    *stats = {all.frameIndex, all.splats, all.millisecondsTotal, all.tau};
  });
}

void UNITY_INTERFACE_API voyUnityLastError(char* text, int capacity) {
  if (!text || capacity < 1) return;
  const std::lock_guard lock(plugin.mutex);
  const size_t length = plugin.error.copy(text, static_cast<size_t>(capacity - 1));
  text[length] = '\0';
}
