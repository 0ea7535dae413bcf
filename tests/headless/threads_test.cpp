// Hosts with threads, and hosts that change the floating-point mode.
#include <cfenv>
#include <chrono>
#include <cstdlib>
#include <thread>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "host.h"

namespace threads_test {
namespace {

TEST(Threads, AViewIsBusyOrAnswers) {
  const Library voy;
  Host host(voy, VOY_DEVICE_DESC_INIT, 1000);
  std::atomic<int> drawn{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (int i = 0; i < 50; ++i) {
        const VoyResult result = host.render();
        EXPECT_TRUE(result == VOY_SUCCESS || result == VOY_ERROR_BUSY) << voy.message();
        drawn += result == VOY_SUCCESS;
        const VoyResult set = voy.SetViewTau(host.view, 3);
        EXPECT_TRUE(set == VOY_SUCCESS || set == VOY_ERROR_BUSY) << voy.message();
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_GT(drawn, 0);
  EXPECT_EQ(host.render(), VOY_SUCCESS);
}

TEST(Threads, ViewsOfOneSceneRenderSideBySide) {
  const Library voy;
  Host host(voy, VOY_DEVICE_DESC_INIT, 1000);
  ASSERT_EQ(host.render(), VOY_SUCCESS);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      std::vector<float> pixels(host.pixels.size());
      VoyTargetDesc target_desc = host.target_desc();
      target_desc.color = pixels.data();
      target_desc.depth = nullptr;
      const VoyViewDesc view_desc = host.view_desc();
      VoyView view = nullptr;
      VoyFrameEye eye = host.eye();
      EXPECT_EQ(voy.CreateTarget(host.device, &target_desc, &eye.target), VOY_SUCCESS);
      EXPECT_EQ(voy.CreateView(host.device, &view_desc, &view), VOY_SUCCESS);
      const VoyFrame frame = Host::frame(eye);
      for (int i = 0; i < 20; ++i) EXPECT_EQ(voy.RenderFrame(view, &frame), VOY_SUCCESS);
      EXPECT_EQ(pixels, host.pixels);
    });
  for (std::thread& thread : threads) thread.join();
}

TEST(Threads, DestructionWaitsForCallsInFlight) {
  const Library voy;
  for (int round = 0; round < 20; ++round) {
    Host host(voy, VOY_DEVICE_DESC_INIT, 500);
    std::atomic<bool> started{false};
    std::thread renderer([&] {
      VoyResult result = VOY_SUCCESS;
      while (result == VOY_SUCCESS || result == VOY_ERROR_BUSY) {
        result = host.render();
        started = true;
      }
      EXPECT_TRUE(result == VOY_ERROR_INVALID_HANDLE || result == VOY_ERROR_SCENE_CLOSED)
          << voy.message();
    });
    while (!started) std::this_thread::yield();
    if (round % 2 == 0) {
      EXPECT_EQ(voy.DestroyDevice(host.device), VOY_SUCCESS);
      // The target's memory is the host's again, though the renderer still tries.
      std::fill(host.pixels.begin(), host.pixels.end(), 0.0f);
      host.device = nullptr;
    } else {
      EXPECT_EQ(voy.CloseScene(host.scene), VOY_SUCCESS);
    }
    renderer.join();
  }
}

// To the host, the destruction of a scene is no use of a view: neither of one that draws it, nor of
// others.
TEST(Threads, AViewIsNotBusyWhileAnotherThreadDestroysScenes) {
  const Library voy;
  Host host(voy, VOY_DEVICE_DESC_INIT, 500);
  std::atomic<bool> done{false};
  std::thread destroyer([&] {
    for (int i = 0; i < 100; ++i) {
      const VoyByteSource source = host.bytes.source();
      VoySceneDesc desc = VOY_SCENE_DESC_INIT;
      desc.source = &source;
      VoyScene scene = nullptr;
      EXPECT_EQ(voy.OpenScene(host.device, &desc, &scene), VOY_SUCCESS) << voy.message();
      EXPECT_EQ(voy.CloseScene(scene), VOY_SUCCESS) << voy.message();
    }
    EXPECT_EQ(voy.CloseScene(host.scene), VOY_SUCCESS) << voy.message();
    done = true;
  });
  while (!done) {
    const VoyResult result = voy.SetViewTau(host.view, 3);
    EXPECT_TRUE(result == VOY_SUCCESS || result == VOY_ERROR_SCENE_CLOSED) << voy.message();
  }
  destroyer.join();
  EXPECT_EQ(host.render(), VOY_ERROR_SCENE_CLOSED);
}

// Whose release takes its time once told to, so that a destruction can be met halfway.
struct SlowRelease {
  std::atomic<bool> slow{false}, entered{false}, device_gone{false};
  std::atomic<int> late{0};

  static void* allocate(void*, size_t size, size_t alignment) {
    return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  }
  static void release(void* user, void* memory, size_t, size_t) {
    auto* self = static_cast<SlowRelease*>(user);
    if (self->slow) {
      self->entered = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    self->late += self->device_gone;
    std::free(memory);
  }
};

// `destroy` runs in another thread while the device is destroyed in this one.
template <class Destroy>
void expect_no_release_after_the_device(const Destroy& destroy) {
  const Library voy;
  SlowRelease memory;
  const VoyAllocator allocator = {VOY_STRUCTURE_TYPE_ALLOCATOR, nullptr, &memory,
                                  SlowRelease::allocate, SlowRelease::release};
  // The CPU's views live in the host's memory; a CUDA device's release none of it.
  VoyDeviceDesc desc = device_for(VOY_BACKEND_CPU);
  desc.allocator = &allocator;
  Host host(voy, desc);
  ASSERT_EQ(host.render(), VOY_SUCCESS);
  memory.slow = true;
  std::atomic<bool> destroyed{false};
  std::thread child([&] {
    EXPECT_EQ(destroy(voy, host), VOY_SUCCESS) << voy.message();
    destroyed = true;
  });
  while (!memory.entered && !destroyed) std::this_thread::yield();
  EXPECT_TRUE(memory.entered) << "it released nothing through the host's allocator";
  EXPECT_EQ(voy.DestroyDevice(host.device), VOY_SUCCESS);
  memory.device_gone = true;
  child.join();
  EXPECT_EQ(memory.late, 0) << "releases after voyDestroyDevice returned";
  host.device = nullptr;
}

TEST(Threads, DestroyingADeviceWaitsForTheDestructionOfItsScene) {
  expect_no_release_after_the_device(
      [](const Library& voy, Host& host) { return voy.CloseScene(host.scene); });
}

TEST(Threads, DestroyingADeviceWaitsForTheDestructionOfItsView) {
  expect_no_release_after_the_device(
      [](const Library& voy, Host& host) { return voy.DestroyView(host.view); });
}

TEST(Threads, MessagesAreEachThreadsOwn) {
  const Library voy;
  EXPECT_EQ(voy.message(), "");
  EXPECT_EQ(voy.SetViewTau(nullptr, 1), VOY_ERROR_INVALID_HANDLE);
  const std::string mine = voy.message();
  std::thread([&] {
    EXPECT_EQ(voy.message(), "");
    EXPECT_NE(voy.CreateDevice(nullptr, nullptr), VOY_SUCCESS);
    EXPECT_NE(voy.message(), mine);
  }).join();
  EXPECT_EQ(voy.message(), mine);
}

struct LogRecord {
  std::thread::id thread = std::this_thread::get_id();
  int count[3] = {};
  static void write(void* user, VoyLogLevel level, const char* message) {
    auto* self = static_cast<LogRecord*>(user);
    EXPECT_EQ(std::this_thread::get_id(), self->thread);
    EXPECT_NE(message, nullptr);
    ++self->count[level];
  }
};

TEST(Threads, LogFollowsItsLevelOnTheCallingThread) {
  const Library voy;
  for (const VoyLogLevel level : {VOY_LOG_LEVEL_ERROR, VOY_LOG_LEVEL_WARNING, VOY_LOG_LEVEL_INFO}) {
    LogRecord record;
    VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
    desc.log = LogRecord::write;
    desc.logUser = &record;
    desc.logLevel = level;
    {
      Host host(voy, desc);
      ASSERT_EQ(host.render(), VOY_SUCCESS);
      EXPECT_EQ(record.count[VOY_LOG_LEVEL_ERROR], 0);
      EXPECT_EQ(record.count[VOY_LOG_LEVEL_INFO] > 0, level == VOY_LOG_LEVEL_INFO);
      EXPECT_NE(voy.SetViewTau(host.view, -1), VOY_SUCCESS);
    }
    EXPECT_EQ(record.count[VOY_LOG_LEVEL_ERROR], 1);
  }
}

class HostMode {
 public:
  HostMode() {
    std::fesetround(FE_TOWARDZERO);
#if defined(__SSE2__)
    _mm_setcsr(_mm_getcsr() | 0x8040);  // flush to zero, denormals are zero
    set_ = mode();
#endif
  }
  ~HostMode() {
#if defined(__SSE2__)
    EXPECT_EQ(mode(), set_) << "the call left another mode than it found";
#endif
    EXPECT_EQ(std::fegetround(), FE_TOWARDZERO);
    std::fesetenv(FE_DFL_ENV);
  }

 private:
#if defined(__SSE2__)
  static unsigned mode() {
    return _mm_getcsr() & ~0x3fu;
  }
  unsigned set_ = 0;
#endif
};

TEST(FloatingPointMode, ImagesAreTheSameAndTheModeIsKept) {
  const Library voy;
  Host plain(voy, VOY_DEVICE_DESC_INIT, 2000);
  VoyFrameEye eye = plain.eye(3, 0.2);
  ASSERT_EQ(plain.render(eye), VOY_SUCCESS);
  const std::vector<float> pixels = plain.pixels, depth = plain.depth;

  const VoyByteSource source = plain.bytes.source();
  VoySceneDesc desc = VOY_SCENE_DESC_INIT;
  desc.source = &source;
  VoyView view = nullptr;
  {
    const HostMode mode;
    EXPECT_EQ(voy.OpenScene(plain.device, &desc, &plain.scene), VOY_SUCCESS);
    const VoyViewDesc view_desc = plain.view_desc();
    EXPECT_EQ(voy.CreateView(plain.device, &view_desc, &view), VOY_SUCCESS);
    const VoyFrame frame = Host::frame(eye);
    EXPECT_EQ(voy.RenderFrame(view, &frame), VOY_SUCCESS);
    EXPECT_LT(voy.SetViewTau(view, -1), 0);
  }
  EXPECT_EQ(plain.pixels, pixels);
  EXPECT_EQ(plain.depth, depth);
}

}  // namespace
}  // namespace threads_test
