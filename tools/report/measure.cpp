#include "tools/report/measure.h"

#include "tools/metrics/shimmer.h"
#include "tools/report/compare_images.h"
#include "tools/report/frame_energy.h"
#include "tools/statistics.h"

namespace voyager::tools {
namespace {

// Search to rasterize: resolve, which hands the image out, is apart.
constexpr int kFrameEnd = kResolve;

ReportTimes times_of(const std::vector<FrameStats>& frames, int first, int end) {
  std::vector<double> samples;
  for (const FrameStats& stats : frames) {
    double sum = 0;
    for (int stage = first; stage < end; ++stage) sum += stats.milliseconds[stage];
    samples.push_back(sum);
  }
  return {percentile(samples, 0.5), percentile(samples, 0.95), percentile(samples, 0.99)};
}

double mean(const std::vector<FrameStats>& frames, const auto& value) {
  double sum = 0;
  for (const FrameStats& stats : frames) sum += static_cast<double>(value(stats));
  return sum / static_cast<double>(frames.size());
}

double bytes_moved(const FrameStats& stats) {
  double sum = 0;
  for (int stage = 0; stage < kFrameEnd; ++stage) sum += static_cast<double>(stats.bytes[stage]);
  return sum;
}

void set_times(const std::vector<FrameStats>& frames, ReportRow& row) {
  row.frame = frame_times(frames);
  for (int stage = 0; stage < kStageCount; ++stage)
    row.stages.push_back(times_of(frames, stage, stage + 1));
  row.timed = frames.size();
  row.cut = mean(frames, [](const FrameStats& stats) { return stats.cut_size; });
  row.splats = mean(frames, [](const FrameStats& stats) { return stats.splats; });
  row.pairs = mean(frames, [](const FrameStats& stats) { return stats.pairs_after; });
  row.bytes = mean(frames, bytes_moved);
}

// Of the last time along the path.
void set_drawn_taus(const std::vector<FrameStats>& timed, std::vector<FrameInput>& path) {
  const size_t last = timed.size() - path.size();
  for (size_t i = 0; i < path.size(); ++i) path[i].tau = timed[last + i].tau;
}

std::vector<ComparedFrame> compared_frames(const ReportPlan& plan) {
  std::vector<ComparedFrame> frames;
  for (const size_t i : plan.compared) frames.push_back({i, plan.path[i].eyes[0].camera.width});
  return frames;
}

}  // namespace

ReportTimes frame_times(const std::vector<FrameStats>& frames) {
  return times_of(frames, kSearch, kFrameEnd);
}

double median_tau(const std::vector<FrameStats>& frames) {
  std::vector<double> taus;
  taus.reserve(frames.size());
  for (const FrameStats& stats : frames) taus.push_back(stats.tau);
  return percentile(taus, 0.5);
}

FramePath Measurement::path_of(const ReportCase& is) const {
  FramePath path{plan_.path, plan_.repeats, {}, false};
  for (FrameInput& frame : path.frames) frame.tau = is.tau;
  if (is.time_budget > 0) path.time_budget = TimeBudgetDesc{is.time_budget};
  path.settles = is.time_budget > 0;
  return path;
}

size_t Measurement::frames_drawn(const ReportCase& is) const {
  return path_of(is).frames_drawn();
}

// At the row's τ; one view draws each path, as a host would.
void Measurement::measure_shimmer(const FrameMaker& maker, ReportRow& row) {
  const std::span<const RgbaImage> truth = slow_truth_.get();
  const auto along = [&](std::vector<FrameInput> path, size_t first) -> std::optional<double> {
    if (path.empty()) return std::nullopt;
    for (FrameInput& frame : path) frame.tau = row.tau;
    return shimmer(draw_images(maker, row.is.desc, path, every_index(path.size())),
                   truth.subspan(first, path.size()));
  };
  row.dolly = along(slow_.dolly, 0);
  row.turn = along(slow_.turn, slow_.dolly.size());
}

ReportRow Measurement::run(const ReportCase& is, const std::function<void(size_t)>& frame_done) {
  const FrameMaker maker{backend_, scenes_.get(is.storage, is.sh_degree), workers_};
  FramePath path = path_of(is);
  const size_t timed_frames = path.repeats * path.frames.size();
  FrameEnergy energy(energy_, path.frames_drawn() - timed_frames);
  path.goes_on = [&] { return energy.wants_more(); };
  const FrameRun timed = run_frames(maker, is.desc, path, [&](size_t drawn) {
    energy.frame(drawn);
    frame_done(drawn);
  });
  ReportRow row;
  row.is = is;
  row.joules = energy.joules_a_frame();
  set_times(timed.timed, row);
  row.tau = median_tau(timed.timed);
  set_drawn_taus(timed.timed, path.frames);
  const auto images = draw_images(maker, is.desc, path.frames, plan_.compared);
  pictures_.image = images.front();
  Detail same{is.desc.lod, {}};
  for (const size_t i : plan_.compared) same.taus.push_back(path.frames[i].tau);
  const std::vector<ComparedFrame> frames = compared_frames(plan_);
  row.same = compare_images(images, references_.of(same), frames, workers_);
  row.truth = compare_images(images, truth_.get(), frames, workers_, &pictures_.difference);
  measure_shimmer(maker, row);
  return row;
}

}  // namespace voyager::tools
