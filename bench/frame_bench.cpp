// Time of a frame, stage by stage, through the C ABI.
//
//   VOYAGER_BENCH_SCENE    a .voy, .ply or .spz
//   VOYAGER_BENCH_CAMERAS  its cameras.json: each iteration renders the next camera
//   VOYAGER_BENCH_SIZE     WxH, default 960x540
//
// One benchmark a τ, and one without LoD. Counters are mean milliseconds a stage;
// the time column is a frame's. Medians over repetitions:
// --benchmark_repetitions=9 --benchmark_report_aggregates_only=true
#include <benchmark/benchmark.h>

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

void frames(benchmark::State& state, VoyLod lod, double tau) {
  const std::vector<Camera> cameras = bench_cameras();
  RenderChoices choices;
  choices.lod = lod;
  choices.tau = tau;
  Renderer renderer(setting("VOYAGER_BENCH_SCENE", "demo/city.voy"), choices, cameras[0].width,
                    cameras[0].height);
  double sums[VOY_STAGE_COUNT] = {};
  VoyFrameStats stats = {};
  size_t next = 0;
  renderer.render(cameras[0]);  // warm
  for (auto _ : state) {
    renderer.render(cameras[next++ % cameras.size()]);
    stats = renderer.stats();
    state.SetIterationTime(stats.millisecondsTotal / 1000);
    for (int stage = 0; stage < VOY_STAGE_COUNT; ++stage) sums[stage] += stats.milliseconds[stage];
  }
  for (int stage = 0; stage < VOY_STAGE_COUNT; ++stage)
    state.counters[voyStageName(static_cast<VoyStage>(stage))] =
        benchmark::Counter(sums[stage], benchmark::Counter::kAvgIterations);
  state.counters["cut"] = static_cast<double>(stats.cutSize);
  state.counters["splats"] = static_cast<double>(stats.splats);
  state.counters["pairs"] = static_cast<double>(stats.pairsAfter);
}

BENCHMARK_CAPTURE(frames, tau_0, VOY_LOD_CUT, 0.0)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frames, tau_3, VOY_LOD_CUT, 3.0)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frames, tau_15, VOY_LOD_CUT, 15.0)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frames, all_leaves, VOY_LOD_ALL_LEAVES, 0.0)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace voyager::tools

BENCHMARK_MAIN();
