// A budget of device memory that scenes share, with a module in CUDA's place.
#include <thread>

#include "stuck_folder.h"
#include "tests/headless/baked_scene.h"
#include "tests/headless/host.h"

namespace device_budget_test {
namespace {

constexpr uint64_t kBudget = 750000, kEach = 250000;

VoyScene open_streamed(const Library& voy, VoyDevice device, const VoyByteSource& source) {
  VoySceneStreaming streaming = VOY_SCENE_STREAMING_INIT;
  streaming.memoryBudget = kEach;
  VoySceneDesc desc = VOY_SCENE_DESC_INIT;
  desc.next = &streaming;
  desc.source = &source;
  VoyScene scene = nullptr;
  EXPECT_EQ(voy.OpenScene(device, &desc, &scene), VOY_SUCCESS) << voy.message();
  return scene;
}

uint64_t budget_of(const Library& voy, VoyScene scene) {
  VoyStreamingStats stats = VOY_STREAMING_STATS_INIT;
  EXPECT_EQ(voy.GetStreamingStats(scene, &stats), VOY_SUCCESS) << voy.message();
  return stats.budgetBytes;
}

// Each asks for all that is left, and there is always room for the top of its tree. Both may see
// the same rest, but only one can have it.
TEST(DeviceBudget, TwoScenesThatAskAtOnceNeverGetTheSameRest) {
  const StuckFolder folder;
  const Library voy(folder.library.c_str());
  BytesHost bytes;
  bytes.bytes = baked_bytes(5000);
  VoyDeviceDesc desc = device_for(VOY_BACKEND_CUDA);
  desc.deviceMemoryBudget = kBudget;
  VoyDevice device = nullptr;
  ASSERT_EQ(voy.CreateDevice(&desc, &device), VOY_SUCCESS) << voy.message();
  const VoyByteSource source = bytes.source();
  const VoyScene scenes[] = {open_streamed(voy, device, source),
                             open_streamed(voy, device, source)};
  std::thread threads[2];
  for (int i = 0; i < 2; ++i)
    threads[i] = std::thread([&, scene = scenes[i]] {
      for (int round = 0; round < 60; ++round)
        for (const uint64_t wanted : {uint64_t{0}, kEach})
          EXPECT_EQ(voy.SetSceneMemoryBudget(scene, wanted), VOY_SUCCESS) << voy.message();
    });
  for (std::thread& thread : threads) thread.join();
  for (const VoyScene scene : scenes) EXPECT_LE(budget_of(voy, scene), kEach);
  // What is counted is what they have, so the rest is all there.
  ASSERT_EQ(voy.SetSceneMemoryBudget(scenes[0], 0), VOY_SUCCESS) << voy.message();
  EXPECT_GT(budget_of(voy, scenes[0]), kEach);
  EXPECT_EQ(voy.DestroyDevice(device), VOY_SUCCESS);
}

}  // namespace
}  // namespace device_budget_test
