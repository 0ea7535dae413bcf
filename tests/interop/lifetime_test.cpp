// What a host may do to targets, and what it leaves behind: nothing.
#include <dirent.h>

#include <cstdlib>
#include <fstream>

#include "cuda_driver.h"
#include "frames.h"

namespace lifetime_test {
namespace {

int open_descriptors() {
  int count = 0;
  DIR* folder = ::opendir("/proc/self/fd");
  while (::readdir(folder) != nullptr) ++count;
  ::closedir(folder);
  return count;
}

long resident_pages() {
  long all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident;
}

// Of the GPU that draws, as its driver counts it for all of its APIs; none where there is no CUDA.
class DeviceMemory {
 public:
  explicit DeviceMemory(const VoyCapabilities& capabilities) {
    std::string why;
    if (capabilities.backend == VOY_BACKEND_CUDA) driver_ = CudaDriver::load(why);
    if (driver_) context_ = driver_->create_on(capabilities.deviceUuid);
    EXPECT_EQ(context_ != nullptr, capabilities.backend == VOY_BACKEND_CUDA);
  }
  ~DeviceMemory() {
    if (context_ != nullptr) driver_->destroy_it(context_);
  }
  DeviceMemory(const DeviceMemory&) = delete;
  DeviceMemory& operator=(const DeviceMemory&) = delete;

  int64_t free_bytes() const {
    return context_ == nullptr ? 0 : static_cast<int64_t>(driver_->free_bytes());
  }

 private:
  std::optional<CudaDriver> driver_;
  CudaDriver::Context context_ = nullptr;
};

int wanted_cycles() {
  const char* wanted = std::getenv("VOYAGER_INTEROP_CYCLES");
  return wanted == nullptr ? 60 : std::atoi(wanted);
}

TEST_F(Interop, TargetsComeAndGoWithoutATrace) {
  FOR_EACH_MODE({
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    images.hasDepth = images.hasDepthLimit = VK_TRUE;
    const DeviceMemory memory(capabilities);
    int descriptors = 0;
    long pages = 0;
    int64_t free_bytes = 0;
    const int cycles = wanted_cycles();
    for (int cycle = 0; cycle < cycles; ++cycle) {
      if (cycle == cycles / 2) {
        descriptors = open_descriptors(), pages = resident_pages();
        free_bytes = memory.free_bytes();
      }
      const VoyTarget target = make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images));
      Line line = line_of(target);
      if (cycle % 8 == 0) shoot(line, target, 0, eye(target), 4);
      ASSERT_EQ(voyDestroyTarget(target), VOY_SUCCESS) << voyGetLastErrorMessage();
    }
    EXPECT_EQ(open_descriptors(), descriptors);
    EXPECT_LT(resident_pages() - pages, 4096) << "16 MB in " << cycles / 2 << " cycles";
    EXPECT_LT(free_bytes - memory.free_bytes(), 4 << 20) << "of the device's memory";
  });
}

TEST_F(Interop, DevicesComeAndGoWithoutATrace) {
  int descriptors = 0;
  for (int cycle = 0; cycle < 10; ++cycle) {
    ASSERT_TRUE(create());
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    make_target(target_desc(VOY_COLOR_FORMAT_RGBA16F, &images));  // goes with its device
    ASSERT_EQ(voyDestroyDevice(device), VOY_SUCCESS);
    device = nullptr;
    if (cycle == 4) descriptors = open_descriptors();  // a driver has set up what it keeps
  }
  EXPECT_EQ(open_descriptors(), descriptors);
}

TEST_F(Interop, AViewDrawsIntoTargetsOfChangingSizes) {
  FOR_EACH_MODE({
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    images.imageCount = 1;
    for (const VkExtent2D& size :
         {extent(33, 17), extent(400, 300), extent(1, 1), extent(128, 64)}) {
      const VoyTarget target =
          make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images, size.width, size.height));
      Line line = line_of(target);
      const Shot shot = shoot(line, target, 0, eye(target), 4, size.width, size.height);
      EXPECT_EQ(
          shot.color,
          expected(VOY_COLOR_FORMAT_RGBA8_UNORM, eye(target), 4, size.width, size.height).color);
      EXPECT_EQ(voyDestroyTarget(target), VOY_SUCCESS);
    }
  });
}

// The host's own commands have ended, as Vulkan asks; Voyager's frame need not have.
TEST_F(Interop, ATargetMayGoWhileAFrameIntoItIsUnderWay) {
  FOR_EACH_MODE({
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    for (int round = 0; round < 8; ++round) {
      const VoyTarget target =
          make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images, 400, 300));
      Line line = line_of(target);
      VkCommandBuffer commands = host->begin();
      release(line, target, 0, commands);
      host->finish(commands, {}, line.released(0));
      ASSERT_EQ(render(line, 0, eye(target)), VOY_SUCCESS) << voyGetLastErrorMessage();
      if (round % 2 == 0) {
        ASSERT_EQ(voyDestroyTarget(target), VOY_SUCCESS);
      } else {
        ASSERT_EQ(voyDestroyView(view), VOY_SUCCESS);
        view = make_view();
        ASSERT_EQ(voyDestroyTarget(target), VOY_SUCCESS);
      }
    }
    const VoyTarget target = make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images));
    Line line = line_of(target);
    EXPECT_EQ(shoot(line, target, 1, eye(target), 4).color,
              expected(VOY_COLOR_FORMAT_RGBA8_UNORM, eye(target), 4).color);
  });
}

TEST_F(Interop, StatisticsFollowFramesUnderWay) {
  FOR_EACH_MODE({
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    const VoyTarget target = make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images));
    Line line = line_of(target);
    for (uint32_t frame = 0; frame < 6; ++frame) shoot(line, target, frame % 2, eye(target), 4);
    VoyFrameStats stats = VOY_FRAME_STATS_INIT;
    ASSERT_EQ(voyGetFrameStats(view, &stats), VOY_SUCCESS) << voyGetLastErrorMessage();
    EXPECT_EQ(stats.frameIndex, 5u);
    EXPECT_GT(stats.splats, 100u);
    EXPECT_EQ(stats.pairsDropped, 0u);
    EXPECT_GT(stats.millisecondsTotal, 0);
  });
}

// No semaphore says so: its statistics do.
TEST_F(Interop, WithoutSemaphoresAFrameHasEndedWhenItsCallReturns) {
  for (const VoyVulkanSharing sharing : kSharings) {
    if (!create_if_had(sharing, VOY_VULKAN_SYNC_HOST)) continue;
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    const VoyTarget target =
        make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images, 512, 512));
    Line line = line_of(target);
    for (uint32_t frame = 0; frame < 20; ++frame) {
      VkCommandBuffer commands = host->begin();
      release(line, target, frame % 2, commands);
      host->finish(commands);
      ASSERT_EQ(render(line, frame % 2, eye(target)), VOY_SUCCESS) << voyGetLastErrorMessage();
      VoyFrameStats stats = VOY_FRAME_STATS_INIT;
      ASSERT_EQ(voyGetFrameStats(view, &stats), VOY_SUCCESS) << voyGetLastErrorMessage();
      EXPECT_EQ(stats.frameIndex, frame);
    }
  }
}

// A host's mistake that must not cost it its exit: the Vulkan device goes, the VoyDevice stays.
TEST_F(Interop, AHostThatForgetsItsDeviceExits) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto forget = [&](VoyVulkanSharing sharing, VoyVulkanSync sync) {
    // After the library's own end, which comes to be later; before a leak checker's, which would
    // find what a driver keeps of objects that nobody destroyed.
    std::atexit([] { ::_exit(0); });
    if (!create(sharing, sync)) std::exit(1);
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    const VoyTarget target = make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images));
    Line line = line_of(target);
    shoot(line, target, 0, eye(target), 4);
    host.reset();
    std::exit(0);
  };
  for (const VoyVulkanSharing sharing : kSharings)
    for (const VoyVulkanSync sync : kSyncs)
      if (must_have(sharing, sync)) {
        EXPECT_EXIT(forget(sharing, sync), testing::ExitedWithCode(0), "")
            << mode_name(sharing, sync);
      }
}

}  // namespace
}  // namespace lifetime_test
