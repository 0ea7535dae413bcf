// A host's own CUDA context is current after every call as it was before.
#include "cuda_driver.h"
#include "frames.h"

namespace context_test {
namespace {

// With a context of the host's own, and then with none.
class HostsContext {
 public:
  explicit HostsContext(const CudaDriver& driver)
      : driver_(driver), own_(driver.create_on(nullptr)) {
    EXPECT_NE(own_, nullptr);
  }
  ~HostsContext() {
    driver_.make_current(nullptr);
    driver_.destroy_it(own_);
  }
  HostsContext(const HostsContext&) = delete;
  HostsContext& operator=(const HostsContext&) = delete;

  void make_current(bool own) {
    expected_ = own ? own_ : nullptr;
    driver_.make_current(expected_);
  }
  // The call has returned.
  VoyResult after(VoyResult result, const char* call) const {
    EXPECT_EQ(driver_.current(), expected_) << call;
    return result;
  }

 private:
  const CudaDriver& driver_;
  CudaDriver::Context own_, expected_ = nullptr;
};
#define KEPT(call) context.after(call, #call)

// A view's life in host memory.
void draw_in_host_memory(HostsContext& context) {
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.backend = VOY_BACKEND_CUDA;
  VoyDevice device = nullptr;
  ASSERT_EQ(KEPT(voyCreateDevice(&desc, &device)), VOY_SUCCESS) << voyGetLastErrorMessage();
  BytesHost bytes;
  bytes.bytes = ply_bytes(800);
  const VoyByteSource source = bytes.source();
  VoySceneDesc scene_desc = VOY_SCENE_DESC_INIT;
  scene_desc.source = &source;
  VoyScene scene = nullptr;
  ASSERT_EQ(KEPT(voyOpenScene(device, &scene_desc, &scene)), VOY_SUCCESS);
  VoyViewDesc view_desc = VOY_VIEW_DESC_INIT;
  view_desc.instanceCount = 1;
  view_desc.scenes = &scene;
  view_desc.maxWidth = view_desc.maxHeight = 64;
  VoyView view = nullptr;
  ASSERT_EQ(KEPT(voyCreateView(device, &view_desc, &view)), VOY_SUCCESS);
  std::vector<uint32_t> pixels(64 * 64);
  VoyTargetDesc target_desc = VOY_TARGET_DESC_INIT;
  target_desc.width = target_desc.height = 64;
  target_desc.color = pixels.data();
  VoyTarget target = nullptr;
  ASSERT_EQ(KEPT(voyCreateTarget(device, &target_desc, &target)), VOY_SUCCESS);
  VoyFrameEye eye = VOY_FRAME_EYE_INIT;
  eye.pose.position[2] = 12;
  eye.frustum = {-0.6, 0.6, 0.6, -0.6};
  eye.target = target;
  VoyFrame frame = VOY_FRAME_INIT;
  frame.eyeCount = 1;
  frame.eyes = &eye;
  EXPECT_EQ(KEPT(voyRenderFrame(view, &frame)), VOY_SUCCESS) << voyGetLastErrorMessage();
  frame.eyeCount = 0;
  EXPECT_EQ(KEPT(voyRenderFrame(view, &frame)), VOY_ERROR_INVALID_ARGUMENT);
  VoyFrameStats stats = VOY_FRAME_STATS_INIT;
  EXPECT_EQ(KEPT(voyGetFrameStats(view, &stats)), VOY_SUCCESS);
  EXPECT_GT(stats.splats, 100u);
  EXPECT_EQ(KEPT(voyDestroyView(view)), VOY_SUCCESS);
  EXPECT_EQ(KEPT(voyDestroyTarget(target)), VOY_SUCCESS);
  EXPECT_EQ(KEPT(voyCloseScene(scene)), VOY_SUCCESS);
  EXPECT_EQ(KEPT(voyDestroyDevice(device)), VOY_SUCCESS);
}

TEST(CudaContext, IsTheHostsAfterEachCall) {
  std::string why;
  const auto driver = CudaDriver::load(why);
  if (!driver) VOYAGER_SKIP_WITHOUT(CUDA, why);
  HostsContext context(*driver);
  for (const bool own : {true, false}) {
    context.make_current(own);
    EXPECT_EQ(KEPT(voyQueryBackend(VOY_BACKEND_CUDA)), VOY_SUCCESS) << voyGetLastErrorMessage();
    draw_in_host_memory(context);
  }
}

TEST_F(Interop, TheHostsCudaContextIsCurrentAfterEachCall) {
  std::string why;
  const auto driver = CudaDriver::load(why);
  if (!driver) VOYAGER_SKIP_WITHOUT(CUDA, why);
  HostsContext context(*driver);
  for (const bool own : {true, false}) {
    context.make_current(own);
    FOR_EACH_MODE({
      context.after(VOY_SUCCESS, "create");
      VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
      images.hasDepth = VK_TRUE;
      const VoyTargetDesc desc = target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images);
      VoyTarget target = nullptr;
      ASSERT_EQ(KEPT(voyCreateTarget(device, &desc, &target)), VOY_SUCCESS);
      Line line = line_of(target);
      for (uint32_t frame = 0; frame < 2; ++frame) {
        shoot(line, target, frame, eye(target), 4);
        context.after(VOY_SUCCESS, "a frame");
      }
      EXPECT_EQ(KEPT(voyDestroyTarget(target)), VOY_SUCCESS);
      EXPECT_EQ(KEPT(voyDestroyView(view)), VOY_SUCCESS);
      EXPECT_EQ(KEPT(voyDestroyDevice(device)), VOY_SUCCESS);
      device = nullptr;
    });
  }
}

}  // namespace
}  // namespace context_test
