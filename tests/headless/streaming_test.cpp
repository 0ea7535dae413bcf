// A streamed scene as a host has it: threads that read the host's bytes, budgets, frames that
// wait and frames that do not, refusals.
#include <voyager/voyager_experiment.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "baked_scene.h"
#include "host.h"

namespace streaming_test {
namespace {

// The fixture's scene and view are those of the baked scene, streamed with `megabytes`.
struct StreamedHost : Host {
  explicit StreamedHost(const Library& library, double megabytes,
                        VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT)
      : Host(library, desc) {
    baked.bytes = baked_bytes(20000);
    EXPECT_EQ(open(megabytes), VOY_SUCCESS) << voy.message();
    view_streamed();
  }
  ~StreamedHost() {  // before the bytes that the scene reads
    EXPECT_EQ(voy.DestroyDevice(device), VOY_SUCCESS) << voy.message();
    device = nullptr;
  }
  VoyResult open(double megabytes) {
    const VoyByteSource source = baked.source();
    VoySceneStreaming streaming = VOY_SCENE_STREAMING_INIT;
    streaming.memoryBudget = static_cast<uint64_t>(megabytes * 1e6);
    VoySceneDesc scene_desc = VOY_SCENE_DESC_INIT;
    scene_desc.next = &streaming;
    scene_desc.source = &source;
    return voy.OpenScene(device, &scene_desc, &scene);
  }
  void view_streamed() {
    VoyViewDesc wanted = view_desc();
    wanted.tau = 1;
    EXPECT_EQ(voy.CreateView(device, &wanted, &view), VOY_SUCCESS) << voy.message();
  }
  VoyResult draw(uint32_t wait, uint32_t stand_in = 0) {
    VoyFrameStreaming streaming = VOY_FRAME_STREAMING_INIT;
    streaming.waitResident = wait;
    streaming.allowFallback = stand_in;
    VoyFrameEye one = eye();
    one.target = target;
    VoyFrame frame = VOY_FRAME_INIT;
    frame.next = &streaming;
    frame.eyeCount = 1;
    frame.eyes = &one;
    return voy.RenderFrame(view, &frame);
  }
  VoyStreamingStats streaming() {
    VoyStreamingStats stats = VOY_STREAMING_STATS_INIT;
    EXPECT_EQ(voy.GetStreamingStats(scene, &stats), VOY_SUCCESS) << voy.message();
    return stats;
  }
  VoyFrameStats frame_stats() {
    VoyFrameStats stats = VOY_FRAME_STATS_INIT;
    EXPECT_EQ(voy.GetFrameStats(view, &stats), VOY_SUCCESS);
    return stats;
  }

  BytesHost baked;
};

std::vector<float> resident_image(const Library& voy) {
  StreamedHost host(voy, 0);
  const VoyByteSource source = host.baked.source();
  VoySceneDesc desc = VOY_SCENE_DESC_INIT;
  desc.source = &source;
  EXPECT_EQ(voy.OpenScene(host.device, &desc, &host.scene), VOY_SUCCESS) << voy.message();
  host.view_streamed();
  EXPECT_EQ(host.render(), VOY_SUCCESS) << voy.message();
  return host.pixels;
}

TEST(Streaming, AFrameThatWaitsIsTheResidentImage) {
  const Library voy;
  StreamedHost host(voy, 0);
  ASSERT_EQ(host.draw(1), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(host.pixels, resident_image(voy));
  EXPECT_EQ(host.frame_stats().nodesUnrefined, 0u);
  const VoyStreamingStats stats = host.streaming();
  EXPECT_GT(stats.residentChunks, 0u);
  EXPECT_EQ(stats.missingChunks, 0u);
}

TEST(Streaming, ATooSmallBudgetSaysWhatItTakes) {
  const Library voy;
  StreamedHost host(voy, 0, device_for(VOY_BACKEND_CPU));  // of another, more is the least
  EXPECT_EQ(host.open(0.001), VOY_ERROR_OVER_BUDGET);
  EXPECT_NE(voy.message().find(" MB"), std::string::npos) << voy.message();
  ASSERT_EQ(host.open(0.6), VOY_SUCCESS) << voy.message();
  host.view_streamed();
  EXPECT_EQ(host.draw(0), VOY_SUCCESS) << voy.message();
  EXPECT_GT(host.frame_stats().nodesUnrefined, 0u);
  EXPECT_EQ(host.draw(1), VOY_ERROR_OVER_BUDGET);
  EXPECT_NE(voy.message().find(" MB"), std::string::npos) << voy.message();
  EXPECT_LE(host.streaming().budgetBytes, 600000u);
}

TEST(Streaming, TheDevicesBudgetBindsStreamedScenesToo) {
  const Library voy;
  VoyDeviceDesc desc = device_for(VOY_BACKEND_CPU);
  desc.hostMemoryBudget = 3000000;
  StreamedHost host(voy, 0, desc);
  VoySceneInfo info = VOY_SCENE_INFO_INIT;
  ASSERT_EQ(voy.GetSceneInfo(host.scene, &info), VOY_SUCCESS);
  EXPECT_LE(info.residentBytes, 3000000u);
  const uint64_t counted = host.streaming().budgetBytes;
  EXPECT_LE(counted, 3000000u);
  EXPECT_EQ(host.draw(0), VOY_SUCCESS) << voy.message();
  // A scene that is closed gives all of it back.
  EXPECT_EQ(voy.CloseScene(host.scene), VOY_SUCCESS);
  ASSERT_EQ(host.open(0), VOY_SUCCESS) << voy.message();
  EXPECT_GE(host.streaming().budgetBytes, counted);
}

TEST(Streaming, ABudgetChangesWhileFramesAreDrawn) {
  const Library voy;
  StreamedHost host(voy, 0, device_for(VOY_BACKEND_CPU));  // of another, more is the least
  ASSERT_EQ(host.draw(1), VOY_SUCCESS);
  const std::vector<float> whole = host.pixels;
  ASSERT_EQ(voy.SetSceneMemoryBudget(host.scene, 600000), VOY_SUCCESS) << voy.message();
  EXPECT_LE(host.streaming().budgetBytes, 600000u);
  ASSERT_EQ(host.draw(0), VOY_SUCCESS) << voy.message();
  EXPECT_GT(host.frame_stats().nodesUnrefined, 0u);
  EXPECT_EQ(voy.SetSceneMemoryBudget(host.scene, 10), VOY_ERROR_OVER_BUDGET);
  ASSERT_EQ(voy.SetSceneMemoryBudget(host.scene, 0), VOY_SUCCESS) << voy.message();
  ASSERT_EQ(host.draw(1), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(host.pixels, whole);
}

// The threads go with the scene, whoever forgets what.
TEST(Streaming, ScenesGoWhileTheirBytesAreRead) {
  for (int i = 0; i < 20; ++i) {
    const Library voy;
    StreamedHost host(voy, 0);
    EXPECT_EQ(host.draw(0), VOY_SUCCESS);
    if (i % 2 == 0) {
      EXPECT_EQ(voy.CloseScene(host.scene), VOY_SUCCESS);
    }
  }
  EXPECT_FALSE(Library::is_mapped());
}

struct Warnings {
  std::vector<std::string> messages;
  static void log(void* user, VoyLogLevel level, const char* message) {
    if (level == VOY_LOG_LEVEL_WARNING)
      static_cast<Warnings*>(user)->messages.emplace_back(message);
  }
};

// Once in the log, on the thread of a call; the frame goes on.
TEST(Streaming, AReadThatFailsIsToldOnceAndTriedAgain) {
  const Library voy;
  Warnings warnings;
  VoyDeviceDesc desc = device_for(VOY_BACKEND_CPU);
  desc.log = Warnings::log;
  desc.logUser = &warnings;
  StreamedHost host(voy, 0.6, desc);
  host.baked.failing = host.baked.reads;
  // Room for more than was read at once.
  ASSERT_EQ(voy.SetSceneMemoryBudget(host.scene, 0), VOY_SUCCESS);
  host.baked.failing = host.baked.reads;
  for (int i = 0; i < 400 && (host.streaming().failures == 0 || warnings.messages.empty()); ++i) {
    ASSERT_EQ(host.draw(0), VOY_SUCCESS) << voy.message();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_LE(warnings.messages.size(), 1u);
  ASSERT_EQ(host.draw(1), VOY_SUCCESS) << voy.message();
}

TEST(Streaming, WhatIsOutOfRangeIsRefused) {
  const Library voy;
  StreamedHost host(voy, 0);
  VoyStreamingStats stats = VOY_STREAMING_STATS_INIT;
  EXPECT_EQ(voy.GetStreamingStats(nullptr, &stats), VOY_ERROR_INVALID_HANDLE);
  EXPECT_EQ(voy.GetStreamingStats(host.scene, nullptr), VOY_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(host.draw(2), VOY_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(host.draw(0, 7), VOY_ERROR_INVALID_ARGUMENT);

  VoySceneStreaming streaming = VOY_SCENE_STREAMING_INIT;
  streaming.readerThreadCount = 65;
  const VoyByteSource source = host.baked.source();
  VoySceneDesc desc = VOY_SCENE_DESC_INIT;
  desc.next = &streaming;
  desc.source = &source;
  VoyScene scene = nullptr;
  EXPECT_EQ(voy.OpenScene(host.device, &desc, &scene), VOY_ERROR_INVALID_ARGUMENT);
  streaming.readerThreadCount = 0;
  streaming.reserved = 1;
  EXPECT_EQ(voy.OpenScene(host.device, &desc, &scene), VOY_ERROR_INVALID_ARGUMENT);
  streaming.reserved = 0;
  double start[3] = {0, NAN, 0};
  streaming.startPosition = start;
  EXPECT_EQ(voy.OpenScene(host.device, &desc, &scene), VOY_ERROR_INVALID_ARGUMENT);
  start[1] = 0;
  EXPECT_EQ(voy.OpenScene(host.device, &desc, &scene), VOY_SUCCESS) << voy.message();

  VoyView view = nullptr;
  VoyViewDesc wanted = host.view_desc();
  VoyExperiment experiment = VOY_EXPERIMENT_INIT;
  experiment.search = VOY_SEARCH_EXHAUSTIVE;
  wanted.next = &experiment;
  EXPECT_EQ(voy.CreateView(host.device, &wanted, &view), VOY_ERROR_UNSUPPORTED);
  wanted = host.view_desc();
  wanted.lod = VOY_LOD_ALL_LEAVES;
  EXPECT_EQ(voy.CreateView(host.device, &wanted, &view), VOY_ERROR_UNSUPPORTED);

  // Other formats are loaded whole.
  const VoyByteSource flat = host.bytes.source();
  streaming = VOY_SCENE_STREAMING_INIT;
  desc.source = &flat;
  ASSERT_EQ(voy.OpenScene(host.device, &desc, &scene), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(voy.GetStreamingStats(scene, &stats), VOY_ERROR_UNSUPPORTED);
  EXPECT_EQ(voy.SetSceneMemoryBudget(scene, 1), VOY_ERROR_UNSUPPORTED);
}

// An allocator that holds one thread where it gives memory back.
struct Gate {
  std::atomic<bool> open{false}, reached{false};
  static inline thread_local bool holds = false;

  static void* allocate(void*, size_t size, size_t alignment) {
    void* memory = nullptr;
    return posix_memalign(&memory, std::max(alignment, sizeof(void*)), size) == 0 ? memory
                                                                                  : nullptr;
  }
  static void release(void* user, void* memory, size_t, size_t) {
    auto* self = static_cast<Gate*>(user);
    if (holds) {
      self->reached = true;
      while (!self->open) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::free(memory);
  }
};

// Bytes that take a while, once that is asked for.
struct SlowBytes {
  BytesHost bytes;
  std::atomic<bool> slow{false}, closed{false};
  std::atomic<int> late{0};  // reads that go on although the scene is closed

  static VoyResult read(void* user, uint64_t offset, uint64_t size, void* into) {
    auto* self = static_cast<SlowBytes*>(user);
    if (self->slow) std::this_thread::sleep_for(std::chrono::milliseconds(40));
    self->late += self->closed ? 1 : 0;
    return BytesHost::read(&self->bytes, offset, size, into);
  }
};

// While another thread is still about to destroy a view of it.
TEST(Streaming, NothingIsReadOnceClosingHasReturned) {
  const Library voy;
  Gate gate;
  SlowBytes slow;
  slow.bytes.bytes = baked_bytes(6000);
  const VoyAllocator allocator{VOY_STRUCTURE_TYPE_ALLOCATOR, nullptr, &gate, Gate::allocate,
                               Gate::release};
  VoyDeviceDesc desc = device_for(VOY_BACKEND_CPU);
  desc.allocator = &allocator;
  Host host(voy, desc);
  VoyByteSource source = slow.bytes.source();
  source.user = &slow;
  source.read = SlowBytes::read;
  VoySceneStreaming streaming = VOY_SCENE_STREAMING_INIT;
  streaming.memoryBudget = 400'000;
  VoySceneDesc scene_desc = VOY_SCENE_DESC_INIT;
  scene_desc.next = &streaming;
  scene_desc.source = &source;
  VoyScene scene = nullptr;
  ASSERT_EQ(voy.OpenScene(host.device, &scene_desc, &scene), VOY_SUCCESS) << voy.message();
  VoyViewDesc view_desc = host.view_desc();
  view_desc.scenes = &scene;
  view_desc.tau = 0;
  VoyView view = nullptr;
  ASSERT_EQ(voy.CreateView(host.device, &view_desc, &view), VOY_SUCCESS) << voy.message();
  slow.slow = true;
  VoyFrameEye eye = host.eye();
  eye.target = host.target;
  VoyFrame frame = VOY_FRAME_INIT;
  frame.eyeCount = 1;
  frame.eyes = &eye;
  for (const double x : {0.0, 5.0, -5.0}) {
    eye.pose.position[0] = x;
    ASSERT_EQ(voy.RenderFrame(view, &frame), VOY_SUCCESS) << voy.message();
  }
  std::thread other([&] {
    Gate::holds = true;
    EXPECT_EQ(voy.DestroyView(view), VOY_SUCCESS);
    Gate::holds = false;
  });
  while (!gate.reached) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(voy.CloseScene(scene), VOY_SUCCESS) << voy.message();
  slow.closed = true;
  std::this_thread::sleep_for(std::chrono::milliseconds(150));
  EXPECT_EQ(slow.late, 0);
  gate.open = true;
  other.join();
}

}  // namespace
}  // namespace streaming_test
