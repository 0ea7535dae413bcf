// All of --optimize on the device: stops do not show, all at once and in parts, and it gains what
// the CPU gains.
#include "runtime/optimize/optimize.h"

#include "runtime/lod/validate.h"
#include "runtime/optimize/checkpoint.h"
#include "tests/gpu/splat_test.h"
#include "tests/support/learned_scenes.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_clouds.h"

namespace voyager::test {
namespace optimize_test {
namespace {

class Optimize : public SplatTest {
 protected:
  OptimizeSummary learn(BakedScene& scene, Backend& backend, uint64_t memory,
                        const std::string& name, const Progress& progress = {}) {
    return optimize_nodes(scene,
                          {.pictures = 24, .memory = memory, .held_out = 4, .keep_milliseconds = 0},
                          backend, folder.file(name), workers, progress);
  }

  const TempFolder folder;
  const BakedScene baked = bake(specks(1500, 6, 1));
};

TEST_F(Optimize, StopsDoNotShowAtOnceAndInParts) {
  struct Stop {};
  for (const uint64_t memory : {uint64_t{0}, kMemoryOfParts}) {
    const std::string all = "all" + std::to_string(memory), part = "part" + std::to_string(memory);
    BakedScene expected = baked;
    learn(expected, *cuda, memory, all);
    EXPECT_FALSE(same_merged(expected, baked));
    EXPECT_TRUE(validate(expected).empty()) << validate(expected).front();
    expect_same_leaves(expected, baked);
    EXPECT_EQ(kept_files(folder.file(all)).size() > 1, memory != 0);
    for (const int at : {3, 11}) {
      BakedScene scene = baked;
      int calls = 0;
      EXPECT_THROW(learn(scene, *cuda, memory, part,
                         [&](const char*, uint64_t, uint64_t) {
                           if (++calls == at) throw Stop{};
                         }),
                   Stop);
    }
    // By another backend.
    BakedScene again = baked;
    learn(again, *create_backend(), memory, part);
    EXPECT_TRUE(same_merged(again, expected)) << memory;
  }
}

TEST_F(Optimize, WhatTheCpuLearnedIsNotContinued) {
  BakedScene scene = baked;
  learn(scene, *cpu, 0, "kept");
  scene = baked;
  EXPECT_EQ(error_code([&] { learn(scene, *cuda, 0, "kept"); }), ErrorCode::refused_input);
}

TEST_F(Optimize, GainsWhatTheCpuGains) {
  BakedScene host = baked, device = baked;
  const OptimizeSummary by_host = learn(host, *cpu, 0, "host"),
                        by_device = learn(device, *cuda, 0, "device");
  ASSERT_EQ(by_host.after.size(), by_device.after.size());
  for (size_t i = 0; i < by_host.after.size(); ++i) {
    EXPECT_NEAR(by_device.before[i].cut, by_host.before[i].cut, 0.01);
    EXPECT_NEAR(by_device.after[i].cut, by_host.after[i].cut, 0.2);
  }
}

}  // namespace
}  // namespace optimize_test
}  // namespace voyager::test
