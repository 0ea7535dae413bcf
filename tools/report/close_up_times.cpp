#include "tools/report/close_up_times.h"

#include <fmt/core.h>

#include "tools/frame_path.h"
#include "tools/report/measure.h"

namespace voyager::tools {
namespace {

constexpr size_t kCloseUpSteps = 40;

CloseUpTimes run(const FrameMaker& maker, const ReportCase& is, FramePath path, double budget) {
  path.counts_pixels = false;
  path.settles = budget > 0;
  if (budget > 0) path.time_budget = TimeBudgetDesc{budget};
  const FrameRun run = run_frames(maker, is.desc, path, [](size_t) {});
  double splats = 0;
  for (const FrameStats& stats : run.timed) splats += static_cast<double>(stats.splats);
  return {budget, median_tau(run.timed), splats / static_cast<double>(run.timed.size()),
          frame_times(run.timed)};
}

}  // namespace

std::vector<CloseUpTimes> close_up_times(const FrameMaker& maker, const ReportCase& is,
                                         const Camera& from, double target) {
  const std::vector<Camera> cameras = close_up_cameras(maker, {&from, 1}, kCloseUpSteps);
  if (cameras.empty()) return {};
  const FramePath path{frame_path(cameras, is.tau), 1, {}, false};
  std::vector<CloseUpTimes> times = {run(maker, is, path, 0)};
  if (!maker.scene->flat()) times.push_back(run(maker, is, path, target));
  return times;
}

nlohmann::ordered_json to_json(const CloseUpTimes& times) {
  return {
      {"time_budget_ms",
       times.time_budget > 0 ? nlohmann::ordered_json(times.time_budget) : nullptr},
      {"tau", times.tau},
      {"splats", times.splats},
      {"ms", {{"median", times.frame.median}, {"p95", times.frame.p95}, {"p99", times.frame.p99}}}};
}

std::string close_up_text(const std::vector<CloseUpTimes>& times) {
  if (times.empty()) return {};
  std::string text =
      fmt::format("Close up, {:g} m in front of a surface, the default takes ", kCloseUp);
  for (const CloseUpTimes& row : times)
    text += fmt::format("{}{:.3f} ms, {:.3f} at p95{}", row.time_budget > 0 ? "; " : "",
                        row.frame.median, row.frame.p95,
                        row.time_budget > 0 ? fmt::format(", in a budget of {:.4g} ms (tau {:.3g})",
                                                          row.time_budget, row.tau)
                                            : "");
  return text + ".";
}

}  // namespace voyager::tools
