// The smallest Vulkan engine with splats in it: three frames through a ring of two images, copied
// into an image of the engine's own, and the last one written as a .ppm file.
//
//   vulkan_minimal SCENE OUT.ppm [X Y Z]
//
// The camera stands at X Y Z and looks along z of the scene's axes (x right, y down, z forward).
// Without X Y Z it stands in front of the scene.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>
#include <voyager/voyager.hpp>

#include "gpu.h"

namespace {

constexpr VkExtent2D kExtent = {640, 360};
constexpr uint32_t kImages = 2;  // one for each frame in flight

// Voyager in this engine. Destroyed before the VkDevice.
class Splats {
 public:
  Splats(const Gpu& gpu, const char* path) : gpu_(gpu) {
    VoyVulkanDeviceDesc vulkan = gpu.voyager_desc();
    vulkan.sync = VOY_VULKAN_SYNC_TIMELINE;
    VoyDeviceDesc device = VOY_DEVICE_DESC_INIT;
    device.next = &vulkan;
    device_ = voy::Device::create(device);
    scene_ = device_.open_scene(path);
    const VoyScene scenes[] = {scene_.get()};
    VoyViewDesc view = VOY_VIEW_DESC_INIT;
    view.instanceCount = 1;
    view.scenes = scenes;
    view.maxWidth = kExtent.width;
    view.maxHeight = kExtent.height;
    view_ = device_.create_view(view);
    VoyVulkanTargetDesc ring = VOY_VULKAN_TARGET_DESC_INIT;
    ring.imageCount = kImages;
    VoyTargetDesc target = VOY_TARGET_DESC_INIT;
    target.next = &ring;
    target.kind = VOY_TARGET_KIND_VULKAN;
    target.width = kExtent.width;
    target.height = kExtent.height;
    target_ = device_.create_target(target);
    uint32_t count = 0;
    voy::check(voyGetVulkanImages(target_.get(), kImages, images_, &count));
  }

  VoyPose front() const {
    const VoySceneInfo info = scene_.info();
    VoyPose pose = {};
    for (int i = 0; i < 2; ++i) pose.position[i] = (info.boundsMin[i] + info.boundsMax[i]) / 2;
    pose.position[2] = info.boundsMin[2] - (info.boundsMax[0] - info.boundsMin[0]) / 4;
    return pose;
  }

  // Frame n, counted from 1, in the order of docs/vulkan.md.
  void draw(uint64_t n, const VoyPose& pose, const Picture& into) {
    const auto image = static_cast<uint32_t>(n % kImages);
    gpu_.run({}, {images_[image].released, n}, [&](VkCommandBuffer commands) {
      const VoyVulkanUse use = this->use(commands, image);
      voy::check(voyRecordVulkanRelease(target_.get(), &use));
    });
    render(n, image, pose);
    gpu_.run({images_[image].rendered, n}, {}, [&](VkCommandBuffer commands) {
      const VoyVulkanUse use = this->use(commands, image);
      voy::check(voyRecordVulkanAcquire(target_.get(), &use));
      into.barrier(commands, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
      VoyVulkanCopy copy = VOY_VULKAN_COPY_INIT;
      copy.commandBuffer = commands;
      copy.imageIndex = image;
      copy.into = into.image;
      copy.intoFormat = VK_FORMAT_R8G8B8A8_UNORM;
      voy::check(voyRecordVulkanCopy(target_.get(), &copy));
      into.barrier(commands, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                   VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    });
  }

 private:
  void render(uint64_t n, uint32_t image, const VoyPose& pose) {
    VoyFrameEye eye = VOY_FRAME_EYE_INIT;
    eye.pose = pose;
    eye.frustum = {-1, 1, double{kExtent.height} / kExtent.width,
                   -double{kExtent.height} / kExtent.width};
    eye.target = target_.get();
    VoyVulkanFrame vulkan = VOY_VULKAN_FRAME_INIT;
    vulkan.imageIndex = image;
    vulkan.waitValue = vulkan.signalValue = n;
    VoyFrame frame = VOY_FRAME_INIT;
    frame.next = &vulkan;
    frame.eyeCount = 1;
    frame.eyes = &eye;
    view_.render(frame);
  }

  VoyVulkanUse use(VkCommandBuffer commands, uint32_t image) const {
    VoyVulkanUse use = VOY_VULKAN_USE_INIT;
    use.commandBuffer = commands;
    use.queueFamily = gpu_.queue_family;
    use.imageIndex = image;
    use.layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    use.stages = VK_PIPELINE_STAGE_TRANSFER_BIT;
    return use;
  }

  const Gpu& gpu_;
  voy::Device device_;
  voy::Scene scene_;
  voy::View view_;
  voy::Target target_;
  VoyVulkanImage images_[kImages] = {};
};

void write_ppm(const char* path, const std::vector<unsigned char>& rgba) {
  std::FILE* file = std::fopen(path, "wb");
  if (!file) throw std::runtime_error(std::string(path) + ": cannot be written");
  std::fprintf(file, "P6 %u %u 255\n", kExtent.width, kExtent.height);
  for (size_t i = 0; i < rgba.size(); i += 4) std::fwrite(&rgba[i], 1, 3, file);
  if (std::fclose(file) != 0) throw std::runtime_error(std::string(path) + ": cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 && argc != 6) {
    std::fprintf(stderr, "vulkan_minimal SCENE OUT.ppm [X Y Z]\n");
    return 1;
  }
  try {
    const Gpu gpu;
    const Picture picture(gpu, kExtent);
    Splats splats(gpu, argv[1]);
    VoyPose pose = splats.front();
    for (int i = 3; i < argc; ++i) pose.position[i - 3] = std::atof(argv[i]);
    pose.orientation[0] = 1;  // half a turn about x: the scene has y down and z forward
    pose.orientation[3] = 0;
    for (uint64_t n = 1; n <= 3; ++n) splats.draw(n, pose, picture);
    write_ppm(argv[2], picture.read());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vulkan_minimal: %s\n", error.what());
    return 2;
  }
  return 0;
}
