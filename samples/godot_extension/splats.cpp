#include "splats.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <vector>

namespace voyager_godot {

Splats::~Splats() {
  if (opening_.valid()) opening_.wait();
}

void Splats::open_scene(const std::string& path) {
  const std::lock_guard lock(mutex_);
  path_ = path;
  error_.clear();
  ++wanted_;
}

void Splats::close_scene() {
  open_scene("");
}

std::string Splats::last_error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

std::string Splats::mode() const {
  const std::lock_guard lock(mutex_);
  return mode_;
}

void Splats::report(const char* error) {
  const std::lock_guard lock(mutex_);
  error_ = error;
}

bool Splats::draw(const SplatFrame& frame) {
  try {
    return draw_scene(frame);
  } catch (const std::exception& error) {
    report(error.what());
    return false;
  }
}

bool Splats::draw_scene(const SplatFrame& frame) {
  const NativeDevice native = native_device(frame.rendering_device);
  if (!device_) create_device(native);
  if (native.device != native_.device)
    throw std::runtime_error("found another Vulkan device than in the frame before");
  if (!take_opened_scene()) return false;
  if (!is_perspective(frame.projection))
    throw std::runtime_error("found an orthogonal camera, expected a perspective");
  const GodotTextures into = {native_image(frame.rendering_device, frame.colour),
                              native_image(frame.rendering_device, frame.depth)};
  fit_view(frame.extent);
  if (!images_ || images_->extent().width != frame.extent.width ||
      images_->extent().height != frame.extent.height) {
    images_.reset();
    images_ = std::make_unique<SplatImages>(*functions_, device_, native_, frame.extent);
  }
  VoyFrameEye eye = VOY_FRAME_EYE_INIT;
  eye.pose = scene_pose(frame.camera);
  eye.frustum = frustum(frame.projection);
  eye.target = images_->target();
  VoyFrame desc = VOY_FRAME_INIT;
  desc.eyeCount = 1;
  desc.eyes = &eye;
  desc.nearZ = near_plane(frame.projection);
  images_->draw(view_, desc, into);
  return true;
}

// Godot asks no extension what to enable, and does not tell what it enabled. Vulkan gives out only
// functions of extensions that are enabled. Features cannot be asked for: no timelines.
void Splats::create_device(const NativeDevice& native) {
  loader_ = std::make_unique<VulkanLoader>();
  auto functions = std::make_unique<DeviceFunctions>(loader_->get_instance_proc_addr(), native);
  std::vector<const char*> extensions;
  if (functions->has("vkGetMemoryFdKHR"))
    extensions.push_back(VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME);
  if (functions->has("vkGetMemoryHostPointerPropertiesEXT"))
    extensions.push_back(VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME);
  VoyVulkanDeviceDesc vulkan = VOY_VULKAN_DEVICE_DESC_INIT;
  vulkan.getInstanceProcAddr = loader_->get_instance_proc_addr();
  vulkan.instance = native.instance;
  vulkan.physicalDevice = native.physical;
  vulkan.device = native.device;
  vulkan.vulkanVersion = VK_API_VERSION_1_1;  // Godot's instance has this version or a newer one
  vulkan.deviceExtensionCount = static_cast<uint32_t>(extensions.size());
  vulkan.deviceExtensions = extensions.data();
  vulkan.sync = VOY_VULKAN_SYNC_HOST;
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.next = &vulkan;
  device_ = voy::Device::create(desc);
  native_ = native;
  functions_ = std::move(functions);
  VoyVulkanCapabilities found = VOY_VULKAN_CAPABILITIES_INIT;
  VoyCapabilities all = VOY_CAPABILITIES_INIT;
  all.next = &found;
  voy::check(voyGetCapabilities(device_.get(), &all));
  const std::lock_guard lock(mutex_);
  mode_ = found.sharing == VOY_VULKAN_SHARING_DEVICE
              ? "CUDA draws on Godot's device"
              : std::string("copied from host memory: ") + found.why;
}

// True if the scene that was asked for last is there. Throws why it could not be opened, once.
bool Splats::take_opened_scene() {
  std::string path;
  uint64_t wanted = 0;
  {
    const std::lock_guard lock(mutex_);
    path = path_;
    wanted = wanted_;
  }
  if (opening_.valid()) {
    if (opening_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    voy::Scene opened = opening_.get();
    if (begun_ == wanted) scene_ = std::move(opened);
  }
  if (begun_ == wanted) return static_cast<bool>(scene_);
  view_ = {};
  view_extent_ = {0, 0};
  scene_ = {};
  begun_ = wanted;
  if (!path.empty())
    opening_ = std::async(std::launch::async, [this, path] { return device_.open_scene(path); });
  return false;
}

// A view keeps its cut: another is made only where the image outgrows it.
void Splats::fit_view(VkExtent2D extent) {
  if (extent.width <= view_extent_.width && extent.height <= view_extent_.height) return;
  const VkExtent2D larger = {std::max(extent.width, view_extent_.width),
                             std::max(extent.height, view_extent_.height)};
  const VoyScene scenes[] = {scene_.get()};
  VoyViewDesc desc = VOY_VIEW_DESC_INIT;
  desc.instanceCount = 1;
  desc.scenes = scenes;
  desc.maxWidth = larger.width;
  desc.maxHeight = larger.height;
  view_ = {};  // its buffers go before the new one's come
  view_extent_ = {0, 0};
  view_ = device_.create_view(desc);
  view_extent_ = larger;
}

}  // namespace voyager_godot
