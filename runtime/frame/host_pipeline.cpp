#include "runtime/frame/host_pipeline.h"

#include "runtime/base/clock.h"

namespace voyager {

void HostPipeline::draw(const FrameInput& frame, const Image&, FrameStats& stats) {
  Stopwatch total, stage;
  const auto lap = [&](Stage s) { stats.milliseconds[s] = stage.lap(); };
  search(frame), lap(kSearch);
  project(frame), lap(kProject);
  sort(frame), lap(kSort);
  bin(frame), lap(kBin);
  rasterize(frame), lap(kRasterize);
  stats.total_milliseconds = total.milliseconds();
  collect(stats);
}

void HostPipeline::resolve(const FrameInput& frame, const Image& image, FrameStats& stats) {
  const Stopwatch stage;
  write(frame, image);
  stats.milliseconds[kResolve] = stage.milliseconds();
  stats.total_milliseconds += stats.milliseconds[kResolve];
}

}  // namespace voyager
