#include "runtime/frame/host_pipeline.h"

#include "runtime/base/clock.h"

namespace voyager {

void HostPipeline::draw(const FrameInput& frame, FrameStats& stats) {
  Stopwatch total, stage;
  const auto lap = [&](Stage s) { stats.milliseconds[s] += stage.lap(); };
  search(frame), lap(kSearch);
  project(frame), lap(kProject);
  for (size_t eye = 0; eye < frame.eyes.size(); ++eye) {
    sort(eye), lap(kSort);
    bin(frame, eye), lap(kBin);
    rasterize(frame, eye), lap(kRasterize);
    collect_eye(stats);
  }
  stats.total_milliseconds = total.milliseconds();
  collect(stats);
}

void HostPipeline::resolve(const FrameInput& frame, FrameStats& stats) {
  const Stopwatch stage;
  for (size_t eye = 0; eye < frame.eyes.size(); ++eye) write(frame, eye);
  stats.milliseconds[kResolve] = stage.milliseconds();
  stats.total_milliseconds += stats.milliseconds[kResolve];
}

}  // namespace voyager
