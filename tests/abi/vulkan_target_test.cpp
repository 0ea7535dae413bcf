// A Vulkan target on a device without CUDA, its Vulkan a mock: whose the passed descriptors
// are after each call, and that a frame's wait has its signal.
#include "mock_vulkan_host.h"

#include <cstdlib>

namespace vulkan_target_test {
namespace {

using namespace voyager::test;

struct VulkanTarget : testing::Test {
  static constexpr uint32_t kImages = 2;

  VulkanTarget() : vulkan(vulkan_desc({})), host(voy, cpu_with(vulkan)) {
    for (VoyVulkanImportedImage& image : images) {
      image = VOY_VULKAN_IMPORTED_IMAGE_INIT;
      image.color = mock.host_image(1);
      image.colorMemory = {{descriptor()}, VOY_VULKAN_MEMORY_HANDLE_TYPE, VK_TRUE, 4096, 0};
      image.depth = mock.host_image(1);
      image.depthMemory = {{descriptor()}, VOY_VULKAN_MEMORY_HANDLE_TYPE, VK_TRUE, 4096, 0};
      image.colorUsage = image.depthUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    }
    semaphores.released = mock.host_semaphore(true);
    semaphores.rendered = mock.host_semaphore(true);
    semaphores.releasedHandle.fd = descriptor();
    semaphores.renderedHandle.fd = descriptor();
    ring.imageCount = kImages;
    ring.hasDepth = VK_TRUE;
    ring.images = images;
    ring.semaphoreCount = 1;
    ring.semaphores = &semaphores;
    of_host = mock.live();
  }
  ~VulkanTarget() override {
    for (const auto& [fd, identity] : passed)
      if (identity_of(fd) == identity) ::close(fd);
  }

  int descriptor() {
    const int fd = new_descriptor();
    passed[fd] = identity_of(fd);
    return fd;
  }
  size_t still_open() const {
    size_t open = 0;
    for (const auto& [fd, identity] : passed) open += identity_of(fd) == identity;
    return open;
  }
  VoyResult create() {
    VoyTargetDesc desc = VOY_TARGET_DESC_INIT;
    desc.next = &ring;
    desc.kind = VOY_TARGET_KIND_VULKAN;
    desc.colorFormat = VOY_COLOR_FORMAT_RGBA8_UNORM;
    desc.width = Host::kWidth;
    desc.height = Host::kHeight;
    return voy.CreateTarget(host.device, &desc, &target);
  }
  void release(uint32_t image) {
    VoyVulkanUse use = VOY_VULKAN_USE_INIT;
    use.commandBuffer = VulkanMock::commands_at(0);
    use.imageIndex = image;
    EXPECT_EQ(voyRecordVulkanRelease(target, &use), VOY_SUCCESS) << voy.message();
  }
  VoyResult render(uint64_t wait, uint64_t signal, uint32_t image = 0) {
    VoyVulkanFrame sync = VOY_VULKAN_FRAME_INIT;
    sync.imageIndex = image;
    sync.waitValue = wait;
    sync.signalValue = signal;
    VoyFrameEye eye = host.eye();
    eye.target = target;
    VoyFrame frame = Host::frame(eye);
    frame.next = &sync;
    return voy.RenderFrame(host.view, &frame);
  }

  VulkanMock mock;
  Library voy;
  VoyVulkanDeviceDesc vulkan;
  Host host;
  VoyVulkanImportedImage images[kImages];
  VoyVulkanImportedSemaphores semaphores = VOY_VULKAN_IMPORTED_SEMAPHORES_INIT;
  VoyVulkanTargetDesc ring = VOY_VULKAN_TARGET_DESC_INIT;
  VoyTarget target = nullptr;
  std::map<int, FileIdentity> passed;
  size_t of_host = 0;
};

TEST_F(VulkanTarget, TheDescriptorsAreTheLibrarysOnceTheCallSucceedsAndClosedOnce) {
  const int bad = bad_closes, before = closes;
  EXPECT_EQ(still_open(), passed.size());
  ASSERT_EQ(create(), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(still_open(), 0u);
  EXPECT_EQ(closes - before, static_cast<int>(passed.size()));
  ASSERT_EQ(voy.DestroyTarget(target), VOY_SUCCESS);
  EXPECT_EQ(closes - before, static_cast<int>(passed.size()));
  EXPECT_EQ(bad_closes, bad);
  EXPECT_EQ(mock.live(), of_host) << mock.live_kinds();
}

// Images in one memory: the host may have exported it once.
TEST_F(VulkanTarget, ADescriptorThatIsPassedForSeveralImagesIsClosedOnce) {
  for (VoyVulkanImportedImage& image : images) {
    image.colorMemory.handle.fd = images[0].colorMemory.handle.fd;
    image.depthMemory.handle.fd = images[0].colorMemory.handle.fd;
  }
  semaphores.releasedHandle.fd = semaphores.renderedHandle.fd = -1;
  const int bad = bad_closes, before = closes;
  ASSERT_EQ(create(), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(closes - before, 1);
  EXPECT_EQ(bad_closes, bad);
}

TEST_F(VulkanTarget, WhateverCallFailsTheDescriptorsStayTheHosts) {
  const std::pair<VkResult, VoyResult> failures[] = {
      {VK_ERROR_OUT_OF_HOST_MEMORY, VOY_ERROR_OUT_OF_HOST_MEMORY},
      {VK_ERROR_OUT_OF_DEVICE_MEMORY, VOY_ERROR_OVER_BUDGET},
      {VK_ERROR_DEVICE_LOST, VOY_ERROR_DEVICE_LOST}};
  const int bad = bad_closes;
  for (const auto& [status, result] : failures) {
    for (uint32_t call = 0;; ++call) {
      mock.fail_at(call, status);
      const VoyResult found = create();
      const bool failed = mock.failed();
      mock.fail_at(VulkanMock::kNever, VK_SUCCESS);
      if (!failed) {
        EXPECT_EQ(found, VOY_SUCCESS);
        EXPECT_GT(call, 4u);
        break;
      }
      EXPECT_EQ(found, result) << "call " << call;
      EXPECT_EQ(still_open(), passed.size()) << "call " << call;
      EXPECT_EQ(mock.live(), of_host) << "call " << call << ": " << mock.live_kinds();
    }
    ASSERT_EQ(voy.DestroyTarget(target), VOY_SUCCESS);
    // The library has closed them: the next round has others.
    passed.clear();
    for (VoyVulkanImportedImage& image : images)
      image.colorMemory.handle.fd = descriptor(), image.depthMemory.handle.fd = descriptor();
    semaphores.releasedHandle.fd = descriptor();
    semaphores.renderedHandle.fd = descriptor();
  }
  EXPECT_EQ(bad_closes, bad);
}

TEST_F(VulkanTarget, RefusedDescriptionsLeaveTheDescriptorsToTheHost) {
  const VoyVulkanTargetDesc good = ring;
  ring.imageCount = 0;
  EXPECT_EQ(create(), VOY_ERROR_INVALID_ARGUMENT);
  ring = good;
  ring.semaphoreCount = 2;
  EXPECT_EQ(create(), VOY_ERROR_INVALID_ARGUMENT);
  ring = good;
  ring.hasDepth = VK_FALSE;
  EXPECT_EQ(create(), VOY_ERROR_INVALID_ARGUMENT);
  ring = good;
  images[1].colorUsage = VK_IMAGE_USAGE_SAMPLED_BIT;
  EXPECT_EQ(create(), VOY_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(voy.message().find("images[1].colorUsage: found"), std::string::npos) << voy.message();
  images[1].colorUsage = images[0].colorUsage;
  semaphores.rendered = VK_NULL_HANDLE;
  EXPECT_EQ(create(), VOY_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(
      voy.message().find("semaphores[0].rendered: found VK_NULL_HANDLE, expected a semaphore"),
      std::string::npos)
      << voy.message();
  EXPECT_EQ(still_open(), passed.size());
  EXPECT_EQ(mock.live(), of_host) << mock.live_kinds();
}

// Zeroed structures name the host's standard input.
TEST_F(VulkanTarget, WhatIsNoDescriptorIsRefusedThoughItHasNoUse) {
  const auto expect_refused = [&](int& fd, int found, const char* field) {
    const int kept = std::exchange(fd, found);
    EXPECT_EQ(create(), VOY_ERROR_INVALID_ARGUMENT) << field;
    EXPECT_NE(voy.message().find(field), std::string::npos) << voy.message();
    fd = kept;
  };
  const int closed = new_descriptor();
  ::close(closed);
  for (const int found : {closed, -2}) {
    expect_refused(images[1].colorMemory.handle.fd, found, "images[1].colorMemory");
    expect_refused(images[0].depthMemory.handle.fd, found, "images[0].depthMemory");
    expect_refused(semaphores.releasedHandle.fd, found, "semaphores[0].releasedHandle.fd");
    expect_refused(semaphores.renderedHandle.fd, found, "semaphores[0].renderedHandle.fd");
  }
  ASSERT_TRUE(is_open(0));
  const VoyVulkanMemory kept = std::exchange(images[0].colorMemory, VoyVulkanMemory{});
  EXPECT_EQ(create(), VOY_ERROR_INVALID_ARGUMENT);
  images[0].colorMemory = kept;
  const int fds[] = {semaphores.releasedHandle.fd, semaphores.renderedHandle.fd};
  semaphores.releasedHandle.fd = semaphores.renderedHandle.fd = 0;
  EXPECT_EQ(create(), VOY_ERROR_INVALID_ARGUMENT);
  semaphores.releasedHandle.fd = fds[0], semaphores.renderedHandle.fd = fds[1];
  EXPECT_TRUE(is_open(0));
  EXPECT_EQ(still_open(), passed.size());
  EXPECT_EQ(create(), VOY_SUCCESS) << voy.message();
}

// A handle whose type the library does not know would be read as the wrong union member.
TEST_F(VulkanTarget, HandlesOfAnotherTypeAreRefusedByName) {
  images[0].depthMemory.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_WIN32_BIT;
  EXPECT_EQ(create(), VOY_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(voy.message().find("images[0].depthMemory.handleType"), std::string::npos)
      << voy.message();
  images[0].depthMemory.handleType = VOY_VULKAN_MEMORY_HANDLE_TYPE;
  semaphores.handleType = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_SYNC_FD_BIT;
  EXPECT_EQ(create(), VOY_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(voy.message().find("semaphores[0].handleType"), std::string::npos) << voy.message();
  EXPECT_EQ(still_open(), passed.size());
}

TEST_F(VulkanTarget, AnImageThatIsPassedTwiceIsRefused) {
  for (VkImage* image : {&images[1].color, &images[1].depth, &images[0].depth}) {
    const VkImage kept = std::exchange(*image, images[0].color);
    EXPECT_EQ(create(), VOY_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(voy.message().find("passed before"), std::string::npos) << voy.message();
    *image = kept;
  }
  EXPECT_EQ(still_open(), passed.size());
}

// As in Vulkan and C: what is not 0 is true.
TEST_F(VulkanTarget, ABooleanIsWhatIsNotZero) {
  ring.hasDepth = 2;
  ring.hasDepthLimit = 0x100;
  ASSERT_EQ(create(), VOY_SUCCESS) << voy.message();
  VoyVulkanDepthLimit limit = VOY_VULKAN_DEPTH_LIMIT_INIT;
  limit.commandBuffer = VulkanMock::commands_at(0);
  limit.depth = images[0].depth;
  EXPECT_EQ(voyRecordVulkanDepthLimit(target, &limit), VOY_SUCCESS) << voy.message();
  vulkan.timelineSemaphore = 4;
  vulkan.sync = VOY_VULKAN_SYNC_TIMELINE;
  const VoyDeviceDesc desc = cpu_with(vulkan);
  VoyDevice device = nullptr;
  EXPECT_EQ(voy.CreateDevice(&desc, &device), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(voy.DestroyDevice(device), VOY_SUCCESS);
}

// Their sum with the target's size would be no int32_t.
TEST_F(VulkanTarget, OffsetsFromWhichTheTargetReachesNoPixelAreRefused) {
  ring.hasDepthLimit = VK_TRUE;
  ASSERT_EQ(create(), VOY_SUCCESS) << voy.message();
  const VkOffset2D offsets[] = {{INT32_MAX, 0}, {0, INT32_MAX}, {INT32_MAX - 10, 3}, {-1, 0}};
  VoyVulkanCopy copy = VOY_VULKAN_COPY_INIT;
  copy.commandBuffer = VulkanMock::commands_at(0);
  copy.into = images[0].color;
  copy.intoFormat = VK_FORMAT_B8G8R8A8_UNORM;
  VoyVulkanDepthLimit limit = VOY_VULKAN_DEPTH_LIMIT_INIT;
  limit.commandBuffer = copy.commandBuffer;
  limit.depth = images[0].depth;
  VoyVulkanCompositeDesc composite_desc = VOY_VULKAN_COMPOSITE_DESC_INIT;
  composite_desc.renderPass = VulkanMock::as<VkRenderPass>(7);
  composite_desc.colorFormat = VK_FORMAT_B8G8R8A8_UNORM;
  VoyVulkanComposite composite = nullptr;
  ASSERT_EQ(voyCreateVulkanComposite(host.device, &composite_desc, &composite), VOY_SUCCESS)
      << voy.message();
  VoyVulkanCompositeDraw draw = VOY_VULKAN_COMPOSITE_DRAW_INIT;
  draw.commandBuffer = copy.commandBuffer;
  draw.target = target;
  draw.area.extent = {Host::kWidth, Host::kHeight};
  for (const VkOffset2D& offset : offsets) {
    copy.intoOffset = limit.depthOffset = draw.area.offset = offset;
    EXPECT_EQ(voyRecordVulkanCopy(target, &copy), VOY_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(voyRecordVulkanDepthLimit(target, &limit), VOY_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(voyRecordVulkanComposite(composite, &draw), VOY_ERROR_INVALID_ARGUMENT);
  }
  EXPECT_TRUE(mock.commands.empty());
  copy.intoOffset = {INT32_MAX - static_cast<int32_t>(Host::kWidth), 0};
  EXPECT_EQ(voyRecordVulkanCopy(target, &copy), VOY_SUCCESS) << voy.message();
}

TEST_F(VulkanTarget, AFrameIntoAnImageThatTheHostDidNotReleaseIsRefused) {
  ASSERT_EQ(create(), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(render(0, 1), VOY_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(voy.message().find("never released"), std::string::npos) << voy.message();
  release(0);
  EXPECT_EQ(render(0, 1, 1), VOY_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(render(0, 1), VOY_SUCCESS) << voy.message();
}

TEST_F(VulkanTarget, AFrameWaitsForReleasedAndSignalsRenderedOnce) {
  ASSERT_EQ(create(), VOY_SUCCESS) << voy.message();
  release(0);
  EXPECT_EQ(render(1, 1), VOY_ERROR_TIMEOUT);
  EXPECT_TRUE(mock.signals.empty());
  mock.signal(semaphores.released, 1);
  EXPECT_EQ(render(1, 1), VOY_SUCCESS) << voy.message();
  ASSERT_EQ(mock.signals.size(), 1u);
  EXPECT_EQ(mock.signals[0].semaphore, semaphores.rendered);
  EXPECT_EQ(mock.signals[0].value, 1u);
  EXPECT_EQ(render(1, 1), VOY_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(render(1, 2, kImages), VOY_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mock.signals.size(), 1u);
}

// A host that forgot its VoyDevice: what it had of Vulkan is gone when the process ends.
TEST_F(VulkanTarget, WhatAHostForgetsCallsNoVulkanAtUnload) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  mock.signal(semaphores.released, 1);
  ASSERT_EQ(create(), VOY_SUCCESS) << voy.message();
  release(0);
  ASSERT_EQ(render(1, 1), VOY_SUCCESS) << voy.message();
  const auto leave = [] {
    VulkanMock::current = nullptr;  // whatever is called now crashes
    std::exit(0);
  };
  EXPECT_EXIT(leave(), testing::ExitedWithCode(0), "");
}

TEST_F(VulkanTarget, TheModeIsTold) {
  VoyVulkanCapabilities found = VOY_VULKAN_CAPABILITIES_INIT;
  VoyCapabilities capabilities = VOY_CAPABILITIES_INIT;
  capabilities.next = &found;
  ASSERT_EQ(voy.GetCapabilities(host.device, &capabilities), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(found.sharing, VOY_VULKAN_SHARING_HOST);
  EXPECT_EQ(found.sync, VOY_VULKAN_SYNC_TIMELINE);
  EXPECT_STREQ(found.why, "the backend does not draw on this device");
  // Where both are missing, both are named.
  vulkan.timelineSemaphore = VK_FALSE;
  const VoyDeviceDesc without = cpu_with(vulkan);
  VoyDevice other = nullptr;
  ASSERT_EQ(voy.CreateDevice(&without, &other), VOY_SUCCESS) << voy.message();
  VoyVulkanCapabilities lacking = VOY_VULKAN_CAPABILITIES_INIT;
  capabilities.next = &lacking;
  ASSERT_EQ(voy.GetCapabilities(other, &capabilities), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(lacking.why, std::string(found.why) + "; the feature timelineSemaphore is not enabled");
  EXPECT_EQ(voy.DestroyDevice(other), VOY_SUCCESS);
  vulkan.sharing = VOY_VULKAN_SHARING_DEVICE;
  const VoyDeviceDesc desc = cpu_with(vulkan);
  VoyDevice refused = nullptr;
  EXPECT_EQ(voy.CreateDevice(&desc, &refused), VOY_ERROR_UNSUPPORTED);
  EXPECT_NE(voy.message().find(found.why), std::string::npos) << voy.message();
}

}  // namespace
}  // namespace vulkan_target_test
