// Callbacks that fail, at every place where they can, and what the host gets back.
#include <sys/resource.h>

#include <fstream>
#include <stdexcept>

#include "counting_allocator.h"
#include "host.h"

namespace memory_test {
namespace {

// Opens, views and renders; the first error, or VOY_SUCCESS.
VoyResult whole_run(const Library& voy, VoyDevice device, BytesHost& bytes,
                    std::vector<float>& pixels) {
  const VoyByteSource source = bytes.source();
  VoySceneDesc scene_desc = VOY_SCENE_DESC_INIT;
  scene_desc.source = &source;
  VoyScene scene = nullptr;
  VoyResult result = voy.OpenScene(device, &scene_desc, &scene);
  EXPECT_EQ(scene == nullptr, result < 0);
  if (result < 0) return result;
  VoyTargetDesc target_desc = VOY_TARGET_DESC_INIT;
  target_desc.width = target_desc.height = 32;
  target_desc.colorFormat = VOY_COLOR_FORMAT_RGBA32F;
  target_desc.color = pixels.data();
  VoyFrameEye eye = VOY_FRAME_EYE_INIT;
  eye.pose.position[2] = 12;
  eye.pose.orientation[3] = 1;
  eye.frustum = {-0.6, 0.6, 0.6, -0.6};
  EXPECT_EQ(voy.CreateTarget(device, &target_desc, &eye.target), VOY_SUCCESS);
  VoyViewDesc view_desc = VOY_VIEW_DESC_INIT;
  view_desc.instanceCount = 1;
  view_desc.scenes = &scene;
  view_desc.maxWidth = view_desc.maxHeight = 32;
  VoyView view = nullptr;
  result = voy.CreateView(device, &view_desc, &view);
  EXPECT_EQ(view == nullptr, result < 0);
  if (result < 0) return result;
  const VoyFrame frame = Host::frame(eye);
  result = voy.RenderFrame(view, &frame);
  if (result < 0) {
    for (const float value : pixels) EXPECT_EQ(value, -1.0f) << "a failed frame wrote";
    // The view is as it was: once there is memory, it draws.
    EXPECT_EQ(voy.RenderFrame(view, &frame), VOY_SUCCESS) << voy.message();
  }
  return result;
}

void fail_every_allocation(VoyBackend backend, bool throws) {
  const Library voy;
  int failures = 0;
  for (int64_t failing = 0;; ++failing) {
    ASSERT_LT(failing, 10000) << "it never completes";
    CountingAllocator memory;
    memory.failing = failing;
    memory.throws = throws;
    const VoyAllocator allocator = memory.desc();
    VoyDeviceDesc desc = device_for(backend);
    desc.allocator = &allocator;
    VoyDevice device = nullptr;
    VoyResult result = voy.CreateDevice(&desc, &device);
    std::vector<float> pixels(size_t{32} * 32 * 4, -1.0f);
    BytesHost bytes;
    bytes.bytes = ply_bytes(100);
    if (result == VOY_SUCCESS) result = whole_run(voy, device, bytes, pixels);
    EXPECT_EQ(voy.DestroyDevice(device), VOY_SUCCESS);
    EXPECT_EQ(memory.bytes_out, 0) << "leaked after failing allocation " << failing;
    if (result == VOY_SUCCESS && memory.allocations <= failing) break;
    EXPECT_EQ(result, VOY_ERROR_OUT_OF_HOST_MEMORY) << voy.message();
    ++failures;
  }
  EXPECT_GT(failures, 5) << "the host's allocator is hardly used";
}

// A source that claims gigabytes, and has two megabytes of them.
TEST(Memory, ASceneTakesMemoryAsItsBytesCome) {
  const Library voy;
  CountingAllocator memory;
  const VoyAllocator allocator = memory.desc();
  VoyDeviceDesc desc = device_for(VOY_BACKEND_CPU);
  desc.allocator = &allocator;
  VoyDevice device = nullptr;
  ASSERT_EQ(voy.CreateDevice(&desc, &device), VOY_SUCCESS);
  constexpr uint64_t kThere = 20000, kClaimed = 20000000;
  BytesHost bytes;
  bytes.bytes = ply_bytes(kThere);
  const size_t header = bytes.bytes.find("end_header\n") + 11;
  const uint64_t row = (bytes.bytes.size() - header) / kThere;
  const size_t digits = bytes.bytes.find(std::to_string(kThere));
  bytes.bytes.replace(digits, std::to_string(kThere).size(), std::to_string(kClaimed));
  VoyByteSource source = bytes.source();
  source.size = header + 3 + kClaimed * row;
  VoySceneDesc scene_desc = VOY_SCENE_DESC_INIT;
  scene_desc.source = &source;
  VoyScene scene = nullptr;
  EXPECT_EQ(voy.OpenScene(device, &scene_desc, &scene), VOY_ERROR_IO) << voy.message();
  EXPECT_GT(memory.most, int64_t{1} << 20);
  EXPECT_LT(memory.most, int64_t{16} << 20);
  EXPECT_EQ(voy.DestroyDevice(device), VOY_SUCCESS);
}

TEST(Memory, EveryAllocationMayFailOnTheCpu) {
  fail_every_allocation(VOY_BACKEND_CPU, false);
}
TEST(Memory, EveryAllocationMayFailOnTheReference) {
  fail_every_allocation(VOY_BACKEND_REFERENCE, false);
}
TEST(Memory, AnAllocatorThatThrowsIsOneThatFails) {
  fail_every_allocation(VOY_BACKEND_CPU, true);
}

TEST(Memory, DestroyingASceneGivesItsMemoryBackThoughAViewRemains) {
  const Library voy;
  CountingAllocator memory;
  const VoyAllocator allocator = memory.desc();
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.allocator = &allocator;
  {
    Host host(voy, desc, 2000);
    ASSERT_EQ(host.render(), VOY_SUCCESS);
    VoySceneInfo info = VOY_SCENE_INFO_INIT;
    ASSERT_EQ(voy.GetSceneInfo(host.scene, &info), VOY_SUCCESS);
    EXPECT_GE(info.residentBytes, 2000u * 4 * (3 + 3 + 4 + 1 + 12));
    const int64_t before = memory.bytes_out;
    EXPECT_LE(static_cast<int64_t>(info.residentBytes), before);
    ASSERT_EQ(voy.CloseScene(host.scene), VOY_SUCCESS);
    EXPECT_LE(memory.bytes_out, before - static_cast<int64_t>(info.residentBytes));
    ASSERT_EQ(voy.DestroyView(host.view), VOY_SUCCESS);
    EXPECT_EQ(memory.bytes_out, 0) << "its buffers, for other scenes, are a view's own";
  }
  EXPECT_EQ(memory.bytes_out, 0);
}

TEST(Memory, ADeviceThatTheHostForgotGoesAtUnload) {
  CountingAllocator memory;
  const VoyAllocator allocator = memory.desc();
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.allocator = &allocator;
  {
    const Library voy;
    Host host(voy, desc);
    ASSERT_EQ(host.render(), VOY_SUCCESS);
    host.device = nullptr;  // forgotten
    EXPECT_GT(memory.bytes_out, 0);
  }
  EXPECT_EQ(memory.bytes_out, 0);
  EXPECT_FALSE(Library::is_mapped());
}

TEST(Memory, TheBudgetBindsAllScenesOfADevice) {
  const Library voy;
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.hostMemoryBudget = 2'000'000;
  Host host(voy, desc, 1000);
  BytesHost bytes;
  bytes.bytes = ply_bytes(20000);
  const VoyByteSource source = bytes.source();
  VoySceneDesc scene_desc = VOY_SCENE_DESC_INIT;
  scene_desc.source = &source;
  VoyScene scene = nullptr;
  EXPECT_EQ(voy.OpenScene(host.device, &scene_desc, &scene), VOY_ERROR_OVER_BUDGET);
  EXPECT_NE(voy.message().find("MB"), std::string::npos) << voy.message();
  EXPECT_NE(voy.message().find("2.000 MB"), std::string::npos) << voy.message();
  // What was refused takes nothing: small scenes fit again and again.
  bytes.bytes = ply_bytes(1000);
  const VoyByteSource small = bytes.source();
  scene_desc.source = &small;
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(voy.OpenScene(host.device, &scene_desc, &scene), VOY_SUCCESS) << voy.message();
    ASSERT_EQ(voy.CloseScene(scene), VOY_SUCCESS);
  }
  EXPECT_EQ(host.render(), VOY_SUCCESS);
}

class Source : public ::testing::Test {
 protected:
  VoyResult open(const VoyByteSource& source) {
    VoySceneDesc desc = VOY_SCENE_DESC_INIT;
    desc.source = &source;
    VoyScene scene = nullptr;
    const VoyResult result = voy.OpenScene(host.device, &desc, &scene);
    EXPECT_EQ(scene == nullptr, result < 0);
    EXPECT_EQ(voy.CloseScene(scene), VOY_SUCCESS);
    return result;
  }

  Library voy;
  Host host{voy};
  BytesHost bytes{ply_bytes(50)};
};

TEST_F(Source, EveryReadMayFail) {
  for (int failing = 0;; ++failing) {
    ASSERT_LT(failing, 10000);
    bytes.failing = failing;
    bytes.reads = 0;
    const VoyResult result = open(bytes.source());
    if (bytes.reads <= failing) {
      EXPECT_EQ(result, VOY_SUCCESS) << voy.message();
      EXPECT_GT(failing, 0);
      break;
    }
    EXPECT_EQ(result, VOY_ERROR_IO) << voy.message();
    EXPECT_NE(voy.message().find("memory.ply"), std::string::npos) << voy.message();
  }
}

TEST_F(Source, EveryTruncationIsRefused) {
  const VoyByteSource whole = bytes.source();
  for (uint64_t size = 0; size < whole.size; ++size) {
    VoyByteSource cut = whole;
    cut.size = size;
    const VoyResult result = open(cut);
    EXPECT_EQ(result, VOY_ERROR_REFUSED_INPUT) << size << ": " << voy.message();
  }
}

// While it lives, no more than so many bytes of address space can be taken: memory by whatever
// allocator. Sanitizers need terabytes of it, and refuse absurd sizes by themselves.
class AddressSpace {
 public:
  explicit AddressSpace(uint64_t more) {
    long pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    ::getrlimit(RLIMIT_AS, &before_);
    rlimit now = before_;
    if (kHeld) now.rlim_cur = static_cast<uint64_t>(pages) * 4096 + more;
    EXPECT_EQ(::setrlimit(RLIMIT_AS, &now), 0);
  }
  ~AddressSpace() { ::setrlimit(RLIMIT_AS, &before_); }
  AddressSpace(const AddressSpace&) = delete;
  AddressSpace& operator=(const AddressSpace&) = delete;

 private:
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  static constexpr bool kHeld = false;
#else
  static constexpr bool kHeld = true;
#endif
  rlimit before_;
};

// What follows the last Gaussian may be ignored or refused, but not believed: memory of a size that
// lies cannot be had here, and asking for it would be VOY_ERROR_OUT_OF_HOST_MEMORY.
TEST_F(Source, SizesThatLieTakeNoMemory) {
  const AddressSpace limited(UINT64_C(256) << 20);
  for (const uint64_t size : {UINT64_MAX, uint64_t{1} << 63, uint64_t{1} << 40}) {
    VoyByteSource source = bytes.source();
    source.size = size;
    const VoyResult result = open(source);
    EXPECT_TRUE(result == VOY_SUCCESS || result == VOY_ERROR_IO ||
                result == VOY_ERROR_REFUSED_INPUT)
        << result << ": " << voy.message();
  }
  // And a header that lies, over a source that agrees with it.
  const size_t at = bytes.bytes.find("vertex 50");
  bytes.bytes.replace(at, 9, "vertex 4000000000");
  VoyByteSource source = bytes.source();
  source.size = UINT64_MAX;
  const VoyResult result = open(source);
  EXPECT_TRUE(result == VOY_ERROR_IO || result == VOY_ERROR_REFUSED_INPUT)
      << result << ": " << voy.message();
}

TEST_F(Source, ReadsThatThrowOrAnswerNonsense) {
  VoyByteSource source = bytes.source();
  source.read = [](void*, uint64_t, uint64_t, void*) -> VoyResult {
    throw std::runtime_error("the host's own trouble");
  };
  EXPECT_EQ(open(source), VOY_ERROR_IO);
  source.read = [](void*, uint64_t, uint64_t, void*) { return VOY_INCOMPLETE; };
  EXPECT_EQ(open(source), VOY_ERROR_IO);
  source.name = nullptr;
  EXPECT_EQ(open(source), VOY_ERROR_IO);
}

}  // namespace
}  // namespace memory_test
