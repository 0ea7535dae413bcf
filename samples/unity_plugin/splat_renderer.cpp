#include "splat_renderer.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace voyager_unity {

SplatRenderer::SplatRenderer(IUnityGraphicsVulkan& unity, const VoyVulkanDeviceDesc& device)
    : unity_(unity), vulkan_(unity.Instance()), functions_(device) {
  VoyVulkanDeviceDesc vulkan = device;
  vulkan.sync = VOY_VULKAN_SYNC_TIMELINE;
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.next = &vulkan;
  device_ = voy::Device::create(desc);
}

SplatRenderer::~SplatRenderer() {
  functions_.wait_idle(functions_.device);
}

void SplatRenderer::open_scene(const char* path) {
  voy::Scene scene = device_.open_scene(path);
  const std::lock_guard lock(mutex_);
  view_ = {};
  view_extent_ = {0, 0};
  scene_ = std::move(scene);
}

void SplatRenderer::close_scene() {
  const std::lock_guard lock(mutex_);
  view_ = {};
  view_extent_ = {0, 0};
  scene_ = {};
}

VoyFrameStats SplatRenderer::stats() {
  const std::lock_guard lock(mutex_);
  return view_.stats();
}

void SplatRenderer::draw(const CameraFrame& frame) {
  const std::lock_guard lock(mutex_);
  if (!scene_) return;
  const UnityVulkanImage colour = observe(frame.colour, "the colour texture");
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  if (frame.depth) {
    const UnityVulkanImage depth = observe(frame.depth, "the depth texture");
    depth_format = depth.format;
    if (depth.extent.width != colour.extent.width || depth.extent.height != colour.extent.height)
      throw std::runtime_error("the depth texture: its size is not that of the colour texture");
  }
  const VkExtent2D extent = {colour.extent.width, colour.extent.height};
  fit_pass(colour.format, depth_format);
  fit_view(extent);
  const bool drawn = !fit_images(extent) && render(frame);
  submit_signals();
  if (drawn) composite(frame);
}

UnityVulkanImage SplatRenderer::observe(void* texture, const char* name) const {
  UnityVulkanImage image = {};
  if (!texture || !unity_.AccessTexture(texture, nullptr, VK_IMAGE_LAYOUT_UNDEFINED, 0, 0,
                                        kUnityVulkanResourceAccess_ObserveOnly, &image))
    throw std::runtime_error(std::string(name) + ": found no texture that Unity knows");
  if (image.samples != VK_SAMPLE_COUNT_1_BIT)
    throw std::runtime_error(std::string(name) + ": found " + std::to_string(image.samples) +
                             " samples, expected 1 (RenderTexture.antiAliasing)");
  return image;
}

UnityVulkanImage SplatRenderer::attach(void* texture, VkImageLayout layout,
                                       VkPipelineStageFlags stages, VkAccessFlags access) const {
  UnityVulkanImage image = {};
  if (!unity_.AccessTexture(texture, nullptr, layout, stages, access,
                            kUnityVulkanResourceAccess_PipelineBarrier, &image))
    throw std::runtime_error("AccessTexture: Unity refused to make a texture an attachment");
  return image;
}

UnityVulkanRecordingState SplatRenderer::recording() const {
  UnityVulkanRecordingState state = {};
  if (!unity_.CommandRecordingState(&state, kUnityVulkanGraphicsQueueAccess_DontCare))
    throw std::runtime_error("CommandRecordingState: Unity has no command buffer");
  return state;
}

void SplatRenderer::retire(std::shared_ptr<void> object, uint64_t frame) {
  if (object) retired_.emplace_back(frame, std::move(object));
}

// True if the images are new: then Voyager has them, and nothing can be drawn in this event.
bool SplatRenderer::fit_images(VkExtent2D extent) {
  const UnityVulkanRecordingState state = recording();
  std::erase_if(retired_, [&](const auto& each) { return each.first <= state.safeFrameNumber; });
  if (images_ && images_->extent().width == extent.width &&
      images_->extent().height == extent.height)
    return false;
  retire(std::move(images_), state.currentFrameNumber);
  images_ = std::make_shared<SplatImages>(functions_, device_, extent, vulkan_.queueFamilyIndex);
  images_->record_first_release(state.commandBuffer);
  return true;
}

void SplatRenderer::fit_pass(VkFormat colour, VkFormat depth) {
  if (pass_ && pass_->fits(colour, depth)) return;
  retire(std::move(pass_), recording().currentFrameNumber);
  pass_ = std::make_shared<CompositePass>(functions_, device_, colour, depth);
}

// A view keeps its cut: another is made only where the image outgrows it.
void SplatRenderer::fit_view(VkExtent2D extent) {
  if (extent.width <= view_extent_.width && extent.height <= view_extent_.height) return;
  view_extent_ = {std::max(extent.width, view_extent_.width),
                  std::max(extent.height, view_extent_.height)};
  const VoyScene scenes[] = {scene_.get()};
  VoyViewDesc desc = VOY_VIEW_DESC_INIT;
  desc.instanceCount = 1;
  desc.scenes = scenes;
  desc.maxWidth = view_extent_.width;
  desc.maxHeight = view_extent_.height;
  view_ = {};  // its buffers go before the new one's come
  view_ = device_.create_view(desc);
}

bool SplatRenderer::render(const CameraFrame& frame) {
  const std::optional<VoyVulkanFrame> vulkan = images_->next_frame();
  if (!vulkan) return false;
  VoyFrameEye eye = VOY_FRAME_EYE_INIT;
  eye.pose = frame.pose;
  eye.frustum = frame.frustum;
  eye.target = images_->target();
  VoyFrame desc = VOY_FRAME_INIT;
  desc.next = &*vulkan;
  desc.eyeCount = 1;
  desc.eyes = &eye;
  desc.nearZ = static_cast<double>(frame.near_z);
  view_.render(desc);
  images_->drawn();
  return true;
}

// Unity's commands so far are submitted before the signals, and those after them later.
void SplatRenderer::submit_signals() {
  unity_.AccessQueue(QueueSignals::submit, 0,
                     images_->queue_signals(vulkan_.graphicsQueue).release(), true);
}

void SplatRenderer::composite(const CameraFrame& frame) {
  const UnityVulkanImage colour =
      attach(frame.colour, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
             VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
             VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
  UnityVulkanImage depth = {};
  if (frame.depth)
    depth = attach(
        frame.depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT,
        VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT);
  const UnityVulkanRecordingState state = recording();  // AccessTexture may have changed it
  VoyVulkanCompositeDraw draw = VOY_VULKAN_COMPOSITE_DRAW_INIT;
  draw.target = images_->target();
  draw.imageIndex = images_->record_acquire(state.commandBuffer);
  draw.area = {{0, 0}, images_->extent()};
  draw.upsideDown = VK_TRUE;  // as Unity draws into textures with Vulkan
  draw.depthUse = frame.depth ? VOY_VULKAN_DEPTH_USE_TEST : VOY_VULKAN_DEPTH_USE_NONE;
  draw.depthEncoding = VOY_DEPTH_ENCODING_REVERSED;  // Unity's with Vulkan
  draw.nearZ = static_cast<double>(frame.near_z);
  draw.farZ = static_cast<double>(frame.far_z);
  try {
    retire(pass_->record(state.commandBuffer, colour, frame.depth ? &depth : nullptr, draw),
           state.currentFrameNumber);
  } catch (...) {  // the image goes back all the same
    images_->record_release(state.commandBuffer, draw.imageIndex);
    throw;
  }
  images_->record_release(state.commandBuffer, draw.imageIndex);
}

}  // namespace voyager_unity
