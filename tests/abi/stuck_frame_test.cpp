// Frames on a device that never end, because the host's signal does not come or a device is
// lost: nothing that the host destroys then hangs.
#include <chrono>
#include <functional>
#include <optional>
#include <utility>

#include "mock_vulkan_host.h"
#include "stuck_folder.h"
#include "stuck_module.h"
#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

namespace stuck_frame_test {
namespace {

using namespace voyager::test;

struct StuckFrame : testing::Test {
  static constexpr const char* kExtensions[] = {VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME,
                                                VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME};

  StuckFrame() : voy(folder.library.c_str()), vulkan(vulkan_desc({})) {
    vulkan.deviceExtensionCount = std::size(kExtensions);
    vulkan.deviceExtensions = kExtensions;
    vulkan.sharing = VOY_VULKAN_SHARING_DEVICE;
    vulkan.sync = VOY_VULKAN_SYNC_BINARY;
    VoyDeviceDesc desc = device_for(VOY_BACKEND_CUDA);
    desc.next = &vulkan;
    desc.log = [](void* user, VoyLogLevel, const char* message) {
      *static_cast<int*>(user) += std::string(message).find("did not finish") != std::string::npos;
    };
    desc.logUser = &logged;
    host.emplace(voy, desc);
    void* file = ::dlopen(folder.module.c_str(), RTLD_NOW | RTLD_NOLOAD);
    module = static_cast<StuckModule*>(::dlsym(file, kStuckModuleSymbol));
    draw();
  }
  ~StuckFrame() override {
    host.reset();
    EXPECT_EQ(mock.live(), 0u) << mock.live_kinds();
  }

  // A frame that waits for a signal of the host's.
  void draw() {
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    VoyTargetDesc desc = VOY_TARGET_DESC_INIT;
    desc.next = &images;
    desc.kind = VOY_TARGET_KIND_VULKAN;
    desc.width = Host::kWidth;
    desc.height = Host::kHeight;
    ASSERT_EQ(voy.CreateTarget(host->device, &desc, &target), VOY_SUCCESS) << voy.message();
    ASSERT_EQ(submit(), VOY_SUCCESS) << voy.message();
  }
  // Releases the image and draws into it.
  VoyResult submit() {
    VoyVulkanUse use = VOY_VULKAN_USE_INIT;
    use.commandBuffer = VulkanMock::commands_at(0);
    const auto release = voy.find<decltype(&::voyRecordVulkanRelease)>("voyRecordVulkanRelease");
    if (!std::exchange(released, true)) {  // for good: it is never acquired
      EXPECT_EQ(release(target, &use), VOY_SUCCESS) << voy.message();
    }
    VoyVulkanFrame sync = VOY_VULKAN_FRAME_INIT;
    sync.waitValue = sync.signalValue = 1;
    VoyFrameEye eye = host->eye();
    eye.target = target;
    VoyFrame frame = Host::frame(eye);
    frame.next = &sync;
    return voy.RenderFrame(host->view, &frame);
  }
  // The device takes part in nothing more, and goes with what is left on it.
  void expect_abandoned() {
    EXPECT_EQ(logged, 1);
    const VoyViewDesc desc = host->view_desc();
    VoyView view = nullptr;
    EXPECT_EQ(voy.CreateView(host->device, &desc, &view), VOY_ERROR_DEVICE_LOST);
    expect_gone();
  }
  void expect_gone() {
    host.reset();
    EXPECT_EQ(module->hangs, 0);
    EXPECT_EQ(logged, 1);
    // Given up once, not once an object.
    const auto took = std::chrono::steady_clock::now() - start;
    EXPECT_GE(took, 5 * kStuckPatience);
    EXPECT_LT(took, std::chrono::seconds(9)) << "the patience of a device that works";
  }

#if defined(__SANITIZE_ADDRESS__)
  __lsan::ScopedDisabler what_is_left;  // on purpose
#endif
  StuckFolder folder;
  VulkanMock mock;
  Library voy;
  VoyVulkanDeviceDesc vulkan;
  int logged = 0;
  std::optional<Host> host;
  StuckModule* module = nullptr;
  VoyTarget target = nullptr;
  bool released = false;
  const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

TEST_F(StuckFrame, NothingIsLeftWhereFramesEnd) {
  EXPECT_EQ(module->pipelines, 1);
  EXPECT_EQ(module->rings, 1);
  host.reset();
  EXPECT_EQ(module->pipelines, 0);
  EXPECT_EQ(module->rings, 0);
  EXPECT_EQ(module->backends, 0);
  EXPECT_EQ(module->hangs, 0);
  EXPECT_EQ(logged, 0);
}

TEST_F(StuckFrame, AViewMayGo) {
  module->idle = false;
  EXPECT_EQ(voy.DestroyView(host->view), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(voy.DestroyTarget(target), VOY_SUCCESS) << voy.message();
  expect_abandoned();
}

TEST_F(StuckFrame, ATargetMayGoBeforeTheViewThatDrewIntoIt) {
  module->idle = false;
  EXPECT_EQ(voy.DestroyTarget(target), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(voy.DestroyView(host->view), VOY_SUCCESS) << voy.message();
  expect_abandoned();
}

TEST_F(StuckFrame, ASceneMayGo) {
  module->idle = false;
  EXPECT_EQ(voy.CloseScene(host->scene), VOY_SUCCESS) << voy.message();
  expect_abandoned();
}

// Each call that waits for the frame says so in the end, and works once the host has signalled.
TEST_F(StuckFrame, CallsThatWaitForItTimeOut) {
  VoyFrameStats stats = VOY_FRAME_STATS_INIT;
  const auto statistics = [&] { return voy.GetFrameStats(host->view, &stats); };
  const auto host_frame = [&] {
    const VoyFrameEye eye = host->eye();
    const VoyFrame frame = Host::frame(eye);
    return voy.RenderFrame(host->view, &frame);
  };
  const auto other_scenes = [&] { return voy.SetViewInstances(host->view, 0, nullptr); };
  const std::function<VoyResult()> calls[] = {statistics, host_frame, other_scenes};
  module->idle = false;
  for (const auto& call : calls) {
    EXPECT_EQ(call(), VOY_ERROR_TIMEOUT) << voy.message();
    EXPECT_NE(voy.message().find("a frame in flight that did not end"), std::string::npos);
  }
  module->idle = true;
  for (const auto& call : calls) EXPECT_EQ(call(), VOY_SUCCESS) << voy.message();
}

// A host that releases images without the signal: frames do not pile up without end.
TEST_F(StuckFrame, FramesInFlightAreCounted) {
  module->idle = false;
  VoyResult result = VOY_SUCCESS;
  int frames = 1;  // the fixture's
  for (; result == VOY_SUCCESS && frames < 100; ++frames) result = submit();
  EXPECT_EQ(result, VOY_ERROR_TIMEOUT) << voy.message();
  EXPECT_EQ(frames, 17);
  module->idle = true;
  EXPECT_EQ(submit(), VOY_SUCCESS) << voy.message();
}

TEST_F(StuckFrame, ADeviceMayGoWithAll) {
  module->idle = false;
  expect_gone();
}

}  // namespace
}  // namespace stuck_frame_test
