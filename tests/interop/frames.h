#pragma once
// A device, a scene and a view on a Vulkan host, and frames through a ring.
#include <unistd.h>

#include <cmath>
#include <memory>
#include <optional>

#include "../headless/scene_bytes.h"
#include "../support/needs.h"
#include "vulkan_memory.h"

inline VkExtent2D extent(uint32_t width, uint32_t height) {
  return {width, height};
}

// Skips where there is no Vulkan device.
class Interop : public ::testing::Test {
 protected:
  static constexpr uint32_t kWidth = 97, kHeight = 61;

  void SetUp() override {
    host = std::make_unique<VulkanHost>();
    if (!host->exists()) VOYAGER_SKIP_WITHOUT(VULKAN, "no Vulkan device");
  }
  void TearDown() override {
    EXPECT_EQ(voyDestroyDevice(device), VOY_SUCCESS) << voyGetLastErrorMessage();
    host.reset();
  }

  // The modes that this machine must have: five where CUDA draws on the Vulkan device, and else
  // what the host's memory can do.
  bool must_have(VoyVulkanSharing sharing, VoyVulkanSync sync) {
    if (sharing == VOY_VULKAN_SHARING_DEVICE) return cuda();
    if (sync == VOY_VULKAN_SYNC_BINARY) return false;
    return sync == VOY_VULKAN_SYNC_HOST || host->timelines == VK_TRUE;
  }
  bool cuda() {
    if (!cuda_) cuda_ = create() && capabilities.backend == VOY_BACKEND_CUDA;
    return *cuda_;
  }
  // A mode is had where it must be, and nowhere else.
  bool create_if_had(VoyVulkanSharing sharing, VoyVulkanSync sync) {
    const bool expected = must_have(sharing, sync), made = create(sharing, sync);
    EXPECT_EQ(made, expected) << mode_name(sharing, sync) << ": " << voyGetLastErrorMessage();
    return made;
  }
  static std::string mode_name(VoyVulkanSharing sharing, VoyVulkanSync sync) {
    return "sharing " + std::to_string(sharing) + ", sync " + std::to_string(sync);
  }

  // False where the mode cannot be had on this machine, for the reason that was given.
  bool create(VoyVulkanSharing sharing = VOY_VULKAN_SHARING_AUTO,
              VoyVulkanSync sync = VOY_VULKAN_SYNC_AUTO) {
    EXPECT_EQ(voyDestroyDevice(device), VOY_SUCCESS);
    device = nullptr;
    const VoyVulkanDeviceDesc vulkan = host->desc(sharing, sync);
    VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
    desc.next = &vulkan;
    const VoyResult result = voyCreateDevice(&desc, &device);
    if (result == VOY_ERROR_UNSUPPORTED) return false;
    EXPECT_EQ(result, VOY_SUCCESS) << voyGetLastErrorMessage();
    VoyCapabilities all = VOY_CAPABILITIES_INIT;
    all.next = &found;
    EXPECT_EQ(voyGetCapabilities(device, &all), VOY_SUCCESS) << voyGetLastErrorMessage();
    capabilities = all;

    bytes.bytes = ply_bytes(gaussians);
    const VoyByteSource source = bytes.source();
    VoySceneDesc scene_desc = VOY_SCENE_DESC_INIT;
    scene_desc.source = &source;
    EXPECT_EQ(voyOpenScene(device, &scene_desc, &scene), VOY_SUCCESS) << voyGetLastErrorMessage();
    view = make_view();
    return true;
  }
  VoyView make_view() {
    VoyViewDesc desc = VOY_VIEW_DESC_INIT;
    desc.instanceCount = 1;
    desc.scenes = &scene;
    desc.maxWidth = desc.maxHeight = 512;
    VoyView made = nullptr;
    EXPECT_EQ(voyCreateView(device, &desc, &made), VOY_SUCCESS) << voyGetLastErrorMessage();
    return made;
  }

  static VoyTargetDesc target_desc(VoyColorFormat format, const VoyVulkanTargetDesc* images,
                                   uint32_t width = kWidth, uint32_t height = kHeight) {
    VoyTargetDesc desc = VOY_TARGET_DESC_INIT;
    desc.next = images;
    desc.kind = VOY_TARGET_KIND_VULKAN;
    desc.colorFormat = format;
    desc.width = width;
    desc.height = height;
    return desc;
  }
  VoyTarget make_target(const VoyTargetDesc& desc) {
    VoyTarget target = nullptr;
    EXPECT_EQ(voyCreateTarget(device, &desc, &target), VOY_SUCCESS) << voyGetLastErrorMessage();
    return target;
  }
  static std::vector<VoyVulkanImage> images_of(VoyTarget target) {
    uint32_t count = 0;
    EXPECT_EQ(voyGetVulkanImages(target, 0, nullptr, &count), VOY_SUCCESS);
    std::vector<VoyVulkanImage> images(count);
    EXPECT_EQ(voyGetVulkanImages(target, count, images.data(), &count), VOY_SUCCESS);
    return images;
  }

  VoyFrameEye eye(VoyTarget target, double x = 0) const {
    VoyFrameEye eye = VOY_FRAME_EYE_INIT;
    eye.pose.position[0] = x;
    eye.pose.position[2] = 12;
    eye.frustum = {-0.6, 0.6, 0.4, -0.4};
    eye.target = target;
    return eye;
  }

  VoyVulkanUse use(VkCommandBuffer commands, uint32_t image) const {
    VoyVulkanUse use = VOY_VULKAN_USE_INIT;
    use.commandBuffer = commands;
    use.queueFamily = host->family;
    use.imageIndex = image;
    use.layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    use.stages = VK_PIPELINE_STAGE_TRANSFER_BIT;
    return use;
  }

  // The semaphores of a target as the mode has them, and the values of the next frame.
  struct Line {
    VoyVulkanSync sync;
    std::vector<VoyVulkanImage> images;
    uint64_t next = 0;  // of timelines

    Point released(uint32_t image) const { return {images[image].released, next}; }
    Point rendered(uint32_t image) const { return {images[image].rendered, next}; }
    VoyVulkanFrame frame(uint32_t image) const {
      VoyVulkanFrame out = VOY_VULKAN_FRAME_INIT;
      out.imageIndex = image;
      if (sync == VOY_VULKAN_SYNC_TIMELINE) out.waitValue = out.signalValue = next;
      if (sync == VOY_VULKAN_SYNC_BINARY) out.waitValue = out.signalValue = 1;
      return out;
    }
  };
  Line line_of(VoyTarget target) const { return {found.sync, images_of(target)}; }

  // The host's side before a frame: its commands and the release.
  // layout: that the image was last acquired in.
  void release(Line& line, VoyTarget target, uint32_t image, VkCommandBuffer commands,
               VkImageLayout layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL) {
    ++line.next;
    VoyVulkanUse wanted = use(commands, image);
    wanted.layout = layout;
    ASSERT_EQ(voyRecordVulkanRelease(target, &wanted), VOY_SUCCESS) << voyGetLastErrorMessage();
  }
  VoyResult render(const Line& line, uint32_t image, const VoyFrameEye& eye,
                   const float* background = nullptr) {
    const VoyVulkanFrame vulkan = line.frame(image);
    VoyFrame frame = VOY_FRAME_INIT;
    frame.next = &vulkan;
    frame.eyeCount = 1;
    frame.eyes = &eye;
    if (background != nullptr) std::copy(background, background + 3, frame.background);
    return voyRenderFrame(view, &frame);
  }

  // A frame from start to end: what its layer holds then.
  struct Shot {
    std::vector<uint8_t> color;
    std::vector<float> depth;
  };
  Shot shoot(Line& line, VoyTarget target, uint32_t image, const VoyFrameEye& eye,
             size_t pixel_bytes, uint32_t width = kWidth, uint32_t height = kHeight) {
    VkCommandBuffer commands = host->begin();
    release(line, target, image, commands);
    host->finish(commands, {}, line.released(image));
    EXPECT_EQ(render(line, image, eye), VOY_SUCCESS) << voyGetLastErrorMessage();
    commands = host->begin();
    const VoyVulkanUse wanted = use(commands, image);
    EXPECT_EQ(voyRecordVulkanAcquire(target, &wanted), VOY_SUCCESS) << voyGetLastErrorMessage();
    const size_t pixels = size_t{width} * height;
    const MappedBuffer read(*host, pixels * (pixel_bytes + sizeof(float)));
    const VoyVulkanImage& held = line.images[image];
    if (pixel_bytes != 0)
      copy_to_buffer(commands, held.color, wanted.layout, extent(width, height), eye.layer,
                     VK_IMAGE_ASPECT_COLOR_BIT, read);
    if (held.depth != VK_NULL_HANDLE)
      copy_to_buffer(commands, held.depth, wanted.layout, extent(width, height), eye.layer,
                     VK_IMAGE_ASPECT_COLOR_BIT, read, pixels * pixel_bytes);
    host->finish(commands, line.rendered(image), {});
    Shot shot;
    shot.color = read.read<uint8_t>(pixels * pixel_bytes);
    if (held.depth != VK_NULL_HANDLE) {
      shot.depth.resize(pixels);
      std::memcpy(shot.depth.data(), static_cast<const char*>(read.data) + pixels * pixel_bytes,
                  pixels * sizeof(float));
    }
    return shot;
  }

  // The same frame in host memory.
  Shot expected(VoyColorFormat format, VoyFrameEye eye, size_t pixel_bytes, uint32_t width = kWidth,
                uint32_t height = kHeight) {
    Shot shot;
    shot.color.resize(size_t{width} * height * pixel_bytes);
    shot.depth.resize(size_t{width} * height);
    VoyTargetDesc desc = VOY_TARGET_DESC_INIT;
    desc.colorFormat = format;
    desc.width = width;
    desc.height = height;
    desc.color = pixel_bytes == 0 ? nullptr : shot.color.data();
    desc.depth = shot.depth.data();
    eye.target = make_target(desc);
    eye.layer = 0;
    VoyFrame frame = VOY_FRAME_INIT;
    frame.eyeCount = 1;
    frame.eyes = &eye;
    const VoyView fresh = make_view();
    EXPECT_EQ(voyRenderFrame(fresh, &frame), VOY_SUCCESS) << voyGetLastErrorMessage();
    EXPECT_EQ(voyDestroyView(fresh), VOY_SUCCESS);
    EXPECT_EQ(voyDestroyTarget(eye.target), VOY_SUCCESS);
    return shot;
  }

  std::unique_ptr<VulkanHost> host;
  int gaussians = 800;  // of the scene that create() opens
  BytesHost bytes;
  VoyDevice device = nullptr;
  VoyScene scene = nullptr;
  VoyView view = nullptr;
  VoyCapabilities capabilities = VOY_CAPABILITIES_INIT;
  VoyVulkanCapabilities found = VOY_VULKAN_CAPABILITIES_INIT;

 private:
  std::optional<bool> cuda_;
};

constexpr VoyVulkanSharing kSharings[] = {VOY_VULKAN_SHARING_DEVICE, VOY_VULKAN_SHARING_HOST};
constexpr VoyVulkanSync kSyncs[] = {VOY_VULKAN_SYNC_TIMELINE, VOY_VULKAN_SYNC_BINARY,
                                    VOY_VULKAN_SYNC_HOST};

// body() for each mode that this machine has; modes_test.cpp names those that it lacks.
#define FOR_EACH_MODE(...)                           \
  do {                                               \
    for (const VoyVulkanSharing sharing : kSharings) \
      for (const VoyVulkanSync sync : kSyncs) {      \
        if (!create_if_had(sharing, sync)) continue; \
        SCOPED_TRACE(mode_name(sharing, sync));      \
        __VA_ARGS__                                  \
      }                                              \
  } while (false)
