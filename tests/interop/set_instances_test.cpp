// Instances that change while frames into a ring are in flight.
#include "frames.h"

namespace set_instances_test {
namespace {

class InteropSetInstances : public Interop {
 protected:
  std::vector<VoyInstance> list_of(uint32_t step) const {
    std::vector<VoyInstance> list(step % 4, VoyInstance VOY_INSTANCE_INIT);
    for (uint32_t i = 0; i < list.size(); ++i) {
      list[i].scene = scene;
      list[i].pose.position[0] = 2.0 * i - 0.3 * step;
      if (step % 3 == 1) list[i].opacity = 0.4f;
      if (step % 5 == 2) list[i].clipMax[1] = 0.5;
    }
    return list;
  }
  static void set(VoyView view, const std::vector<VoyInstance>& list) {
    EXPECT_EQ(voySetViewInstances(view, static_cast<uint32_t>(list.size()), list.data()),
              VOY_SUCCESS)
        << voyGetLastErrorMessage();
  }
  // By a view that has drawn nothing else, in host memory.
  Shot alone(const std::vector<VoyInstance>& list, VoyFrameEye eye) {
    Shot shot;
    shot.color.resize(size_t{4} * kWidth * kHeight);
    shot.depth.resize(size_t{kWidth} * kHeight);
    VoyTargetDesc desc = VOY_TARGET_DESC_INIT;
    desc.width = kWidth, desc.height = kHeight;
    desc.color = shot.color.data();
    desc.depth = shot.depth.data();
    eye.target = make_target(desc);
    const VoyView fresh = make_view();
    set(fresh, list);
    VoyFrame frame = VOY_FRAME_INIT;
    frame.eyeCount = 1;
    frame.eyes = &eye;
    EXPECT_EQ(voyRenderFrame(fresh, &frame), VOY_SUCCESS) << voyGetLastErrorMessage();
    EXPECT_EQ(voyDestroyView(fresh), VOY_SUCCESS);
    EXPECT_EQ(voyDestroyTarget(eye.target), VOY_SUCCESS);
    return shot;
  }
  Shot acquire(Line& line, VoyTarget target, uint32_t image) {
    const VkCommandBuffer commands = host->begin();
    const VoyVulkanUse wanted = use(commands, image);
    EXPECT_EQ(voyRecordVulkanAcquire(target, &wanted), VOY_SUCCESS) << voyGetLastErrorMessage();
    const size_t pixels = size_t{kWidth} * kHeight;
    const MappedBuffer read(*host, 8 * pixels);
    copy_to_buffer(commands, line.images[image].color, wanted.layout, extent(kWidth, kHeight), 0,
                   VK_IMAGE_ASPECT_COLOR_BIT, read);
    copy_to_buffer(commands, line.images[image].depth, wanted.layout, extent(kWidth, kHeight), 0,
                   VK_IMAGE_ASPECT_COLOR_BIT, read, 4 * pixels);
    host->finish(commands, line.rendered(image), {});
    Shot shot;
    shot.color = read.read<uint8_t>(4 * pixels);
    shot.depth.resize(pixels);
    std::memcpy(shot.depth.data(), static_cast<const char*>(read.data) + 4 * pixels, 4 * pixels);
    return shot;
  }
};

// Each image is read after the list has changed again: a frame shows the list that it was drawn
// with.
TEST_F(InteropSetInstances, AFrameInFlightShowsTheListOfItsCall) {
  FOR_EACH_MODE({
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    images.imageCount = 1;
    images.hasDepth = VK_TRUE;
    VoyTarget targets[2];
    for (VoyTarget& target : targets)
      target = make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images));
    Line lines[2] = {line_of(targets[0]), line_of(targets[1])};
    constexpr uint32_t kSteps = 9;
    for (uint32_t step = 0; step <= kSteps; ++step) {
      SCOPED_TRACE("step " + std::to_string(step));
      if (step < kSteps) {
        Line& line = lines[step % 2];
        const VoyTarget target = targets[step % 2];
        set(view, list_of(step));
        const VkCommandBuffer commands = host->begin();
        release(line, target, 0, commands);
        host->finish(commands, {}, line.released(0));
        ASSERT_EQ(render(line, 0, eye(target, 0.2 * step)), VOY_SUCCESS)
            << voyGetLastErrorMessage();
      }
      if (step == 0) continue;
      const uint32_t drawn = step - 1;
      const Shot expected = alone(list_of(drawn), eye(targets[drawn % 2], 0.2 * drawn));
      const Shot shown = acquire(lines[drawn % 2], targets[drawn % 2], 0);
      EXPECT_EQ(shown.color, expected.color);
      EXPECT_EQ(shown.depth, expected.depth);
    }
    for (const VoyTarget target : targets) EXPECT_EQ(voyDestroyTarget(target), VOY_SUCCESS);
  });
}

// A scene is closed with a frame of it in flight, and the view goes on without it.
TEST_F(InteropSetInstances, AViewGoesOnAfterASceneWasClosed) {
  FOR_EACH_MODE({
    BytesHost more;
    more.bytes = ply_bytes(300);
    const VoyByteSource source = more.source();
    VoySceneDesc scene_desc = VOY_SCENE_DESC_INIT;
    scene_desc.source = &source;
    VoyScene other = nullptr;
    ASSERT_EQ(voyOpenScene(device, &scene_desc, &other), VOY_SUCCESS) << voyGetLastErrorMessage();
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    images.imageCount = 2;
    images.hasDepth = VK_TRUE;
    const VoyTarget target = make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images));
    Line line = line_of(target);
    std::vector<VoyInstance> list(2, VoyInstance VOY_INSTANCE_INIT);
    list[0].scene = other, list[1].scene = scene;
    set(view, list);
    const auto draw = [&](uint32_t image) {
      const VkCommandBuffer commands = host->begin();
      release(line, target, image, commands);
      host->finish(commands, {}, line.released(image));
      return render(line, image, eye(target));
    };
    const Shot both = alone(list, eye(target));
    ASSERT_EQ(draw(0), VOY_SUCCESS) << voyGetLastErrorMessage();
    ASSERT_EQ(voyCloseScene(other), VOY_SUCCESS) << voyGetLastErrorMessage();
    list.erase(list.begin());
    set(view, list);
    ASSERT_EQ(draw(1), VOY_SUCCESS) << voyGetLastErrorMessage();
    const Shot first = acquire(line, target, 0), second = acquire(line, target, 1);
    EXPECT_EQ(first.color, both.color);
    EXPECT_EQ(second.color, alone(list, eye(target)).color);
    EXPECT_EQ(voyDestroyTarget(target), VOY_SUCCESS);
  });
}

}  // namespace
}  // namespace set_instances_test
