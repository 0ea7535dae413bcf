// Time of a frame, stage by stage, through the C ABI.
//
//   VOYAGER_BENCH_SCENE    a .voy, .ply or .spz
//   VOYAGER_BENCH_CAMERAS  its cameras.json: each iteration renders the next camera
//   VOYAGER_BENCH_SIZE     WxH, default 960x540
//
// One benchmark a τ, and one without LoD. The time column is the mean of a frame;
// counters are the frames' median and p99 (ms), and means a frame of each stage
// (ms), cut, splats and pairs. --benchmark_min_time=10 makes p99 mean something.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tools/renderer.h"

namespace voyager::tools {
namespace {

const char* setting(const char* name, const char* otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : otherwise;
}

std::vector<Camera> bench_cameras() {
  unsigned width = 0, height = 0;
  std::sscanf(setting("VOYAGER_BENCH_SIZE", "960x540"), "%ux%u", &width, &height);
  std::vector<Camera> cameras =
      read_cameras(setting("VOYAGER_BENCH_CAMERAS", "demo/city.cameras.json"));
  for (Camera& camera : cameras) camera = camera.resized(width, height);
  return cameras;
}

// Sums over the frames of a run.
struct Totals {
  std::vector<double> frame_ms;
  uint32_t stage_count = 0;
  double stage_ms[VOY_MAX_STAGES] = {};
  double cut = 0, splats = 0, pairs = 0;

  void add(const VoyFrameStats& stats) {
    frame_ms.push_back(stats.millisecondsTotal);
    stage_count = stats.stageCount;
    for (uint32_t stage = 0; stage < stage_count; ++stage)
      stage_ms[stage] += stats.milliseconds[stage];
    cut += static_cast<double>(stats.cutSize);
    splats += static_cast<double>(stats.splats);
    pairs += static_cast<double>(stats.pairsAfterFilter);
  }

  double quantile(double share) {
    std::sort(frame_ms.begin(), frame_ms.end());
    return frame_ms[static_cast<size_t>(share * static_cast<double>(frame_ms.size() - 1) + 0.5)];
  }

  void report(benchmark::State& state) {
    const auto mean = [](double sum) {
      return benchmark::Counter(sum, benchmark::Counter::kAvgIterations);
    };
    state.counters["median"] = quantile(0.5);
    state.counters["p99"] = quantile(0.99);
    for (uint32_t stage = 0; stage < stage_count; ++stage)
      state.counters[voyStageName(static_cast<VoyStage>(stage))] = mean(stage_ms[stage]);
    state.counters["cut"] = mean(cut);
    state.counters["splats"] = mean(splats);
    state.counters["pairs"] = mean(pairs);
  }
};

void render_frames(benchmark::State& state, const RenderChoices& choices) {
  const std::vector<Camera> cameras = bench_cameras();
  Renderer renderer(setting("VOYAGER_BENCH_SCENE", "demo/city.voy"), choices, cameras[0].width,
                    cameras[0].height);
  renderer.render({&cameras[0], 1});  // warm
  Totals totals;
  for (auto _ : state) {
    renderer.render({&cameras[totals.frame_ms.size() % cameras.size()], 1});
    totals.add(renderer.stats());
    state.SetIterationTime(totals.frame_ms.back() / 1000);
  }
  totals.report(state);
}

void frames(benchmark::State& state, VoyLod lod, double tau) {
  RenderChoices choices;
  choices.lod = lod;
  choices.tau = tau;
  try {
    render_frames(state, choices);
  } catch (const std::exception& error) {
    state.SkipWithError(error.what());
  }
}

BENCHMARK_CAPTURE(frames, tau_0, VOY_LOD_AUTO, 0.0)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frames, tau_3, VOY_LOD_AUTO, 3.0)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frames, tau_15, VOY_LOD_AUTO, 15.0)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frames, all_leaves, VOY_LOD_ALL_LEAVES, 0.0)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace voyager::tools

BENCHMARK_MAIN();
