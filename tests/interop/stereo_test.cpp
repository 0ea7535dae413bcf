// Both eyes of a frame into a ring: as layers of one image, or into a ring each.
#include "frames.h"

namespace stereo_test {
namespace {

class InteropStereo : public Interop {
 protected:
  VoyView make_pair_view() {
    VoyViewDesc desc = VOY_VIEW_DESC_INIT;
    desc.instanceCount = 1;
    desc.scenes = &scene;
    desc.eyeCount = 2;
    desc.maxWidth = desc.maxHeight = 512;
    VoyView made = nullptr;
    EXPECT_EQ(voyCreateView(device, &desc, &made), VOY_SUCCESS) << voyGetLastErrorMessage();
    return made;
  }
  VoyTarget make_layers(uint32_t layers, uint32_t width = kWidth) {
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    images.imageCount = 2;
    images.layerCount = layers;
    images.hasDepth = VK_TRUE;
    return make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images, width));
  }
  VoyResult render_pair(VoyView pair, const VoyFrameEye* eyes, const VoyVulkanFrame* vulkan) {
    VoyFrame frame = VOY_FRAME_INIT;
    frame.next = vulkan;
    frame.eyeCount = 2;
    frame.eyes = eyes;
    return voyRenderFrame(pair, &frame);
  }
  void release_image(Line& line, VoyTarget target, uint32_t image) {
    const VkCommandBuffer commands = host->begin();
    release(line, target, image, commands);
    host->finish(commands, {}, line.released(image));
  }
  // The image's depth goes behind its colour.
  Shot acquire_layer(Line& line, VoyTarget target, uint32_t image, uint32_t layer, uint32_t width,
                     bool first) {
    const VkCommandBuffer commands = host->begin();
    const VoyVulkanUse wanted = use(commands, image);
    if (first) {
      EXPECT_EQ(voyRecordVulkanAcquire(target, &wanted), VOY_SUCCESS) << voyGetLastErrorMessage();
    }
    const size_t pixels = size_t{width} * kHeight;
    const MappedBuffer read(*host, 8 * pixels);
    copy_to_buffer(commands, line.images[image].color, wanted.layout, extent(width, kHeight), layer,
                   VK_IMAGE_ASPECT_COLOR_BIT, read);
    copy_to_buffer(commands, line.images[image].depth, wanted.layout, extent(width, kHeight), layer,
                   VK_IMAGE_ASPECT_COLOR_BIT, read, 4 * pixels);
    host->finish(commands, first ? line.rendered(image) : Point{}, {});
    Shot shot;
    shot.color = read.read<uint8_t>(4 * pixels);
    shot.depth.resize(pixels);
    std::memcpy(shot.depth.data(), static_cast<const char*>(read.data) + 4 * pixels, 4 * pixels);
    return shot;
  }
  void expect_alone(const Shot& shot, const VoyFrameEye& at, uint32_t width = kWidth) {
    const Shot whole = expected(VOY_COLOR_FORMAT_RGBA8_UNORM, at, 4, width);
    EXPECT_EQ(shot.color, whole.color);
    EXPECT_EQ(shot.depth, whole.depth);
  }
};

// The scene is flat: an eye is to the bit what it is alone.
TEST_F(InteropStereo, EyesAreLayersOfOneImage) {
  FOR_EACH_MODE({
    const VoyTarget target = make_layers(2);
    const VoyView pair = make_pair_view();
    Line line = line_of(target);
    for (uint32_t frame = 0; frame < 5; ++frame) {
      VoyFrameEye eyes[2] = {eye(target, 0.5 * frame), eye(target, 0.5 * frame + 0.1)};
      eyes[1].frustum.left = -0.5;
      // Which layer is whose is the host's to say.
      eyes[0].layer = frame % 2, eyes[1].layer = 1 - frame % 2;
      const uint32_t image = frame % 2;
      release_image(line, target, image);
      const VoyVulkanFrame vulkan = line.frame(image);
      ASSERT_EQ(render_pair(pair, eyes, &vulkan), VOY_SUCCESS) << voyGetLastErrorMessage();
      for (uint32_t i = 0; i < 2; ++i) {
        SCOPED_TRACE("frame " + std::to_string(frame) + ", eye " + std::to_string(i));
        expect_alone(acquire_layer(line, target, image, eyes[i].layer, kWidth, i == 0), eyes[i]);
      }
    }
    VoyFrameStats stats = VOY_FRAME_STATS_INIT;
    EXPECT_EQ(voyGetFrameStats(pair, &stats), VOY_SUCCESS) << voyGetLastErrorMessage();
    EXPECT_EQ(voyDestroyTarget(target), VOY_SUCCESS);
  });
}

TEST_F(InteropStereo, EyesOfTwoSizesGoToARingEach) {
  FOR_EACH_MODE({
    constexpr uint32_t kWider = kWidth + 30;
    const VoyTarget targets[2] = {make_layers(1), make_layers(1, kWider)};
    const uint32_t widths[2] = {kWidth, kWider};
    const VoyView pair = make_pair_view();
    Line lines[2] = {line_of(targets[0]), line_of(targets[1])};
    for (uint32_t frame = 0; frame < 4; ++frame) {
      const VoyFrameEye eyes[2] = {eye(targets[0], 0.5 * frame), eye(targets[1], 0.5 * frame + 1)};
      const uint32_t image = frame % 2;
      for (int i = 0; i < 2; ++i) release_image(lines[i], targets[i], image);
      const VoyVulkanFrame vulkan = lines[0].frame(image);
      ASSERT_EQ(render_pair(pair, eyes, &vulkan), VOY_SUCCESS) << voyGetLastErrorMessage();
      for (int i = 0; i < 2; ++i)
        expect_alone(acquire_layer(lines[i], targets[i], image, 0, widths[i], true), eyes[i],
                     widths[i]);
    }
    for (const VoyTarget target : targets) EXPECT_EQ(voyDestroyTarget(target), VOY_SUCCESS);
  });
}

TEST_F(InteropStereo, EyesThatShareAnImageOrMixKindsAreRefused) {
  ASSERT_TRUE(create());
  const VoyTarget target = make_layers(2);
  std::vector<uint8_t> pixels(size_t{4} * kWidth * kHeight);
  VoyTargetDesc desc = VOY_TARGET_DESC_INIT;
  desc.width = kWidth, desc.height = kHeight;
  desc.color = pixels.data();
  const VoyTarget in_memory = make_target(desc);
  const VoyView pair = make_pair_view();
  const Line line = line_of(target);
  const VoyVulkanFrame vulkan = line.frame(0);
  const auto refused = [&](const VoyFrameEye& left, const VoyFrameEye& right,
                           const VoyVulkanFrame* next, const char* what) {
    const VoyFrameEye eyes[2] = {left, right};
    EXPECT_NE(render_pair(pair, eyes, next), VOY_SUCCESS);
    EXPECT_NE(std::string(voyGetLastErrorMessage()).find(what), std::string::npos)
        << voyGetLastErrorMessage();
  };
  refused(eye(target), eye(target), &vulkan, "frame.eyes[1]");
  refused(eye(target), eye(in_memory), &vulkan, "frame.eyes[1].target");
  refused(eye(in_memory), eye(in_memory), nullptr, "frame.eyes[1]");
  VoyFrameEye beyond = eye(target);
  beyond.layer = 2;
  refused(eye(target), beyond, &vulkan, "frame.eyes[1].layer");
}

}  // namespace
}  // namespace stereo_test
