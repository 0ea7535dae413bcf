#include "tools/report/measure.h"

#include "runtime/base/clock.h"
#include "tools/report/compare_images.h"
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
  row.frame = times_of(frames, kSearch, kFrameEnd);
  for (int stage = 0; stage < kStageCount; ++stage)
    row.stages.push_back(times_of(frames, stage, stage + 1));
  row.timed = frames.size();
  row.cut = mean(frames, [](const FrameStats& stats) { return stats.cut_size; });
  row.splats = mean(frames, [](const FrameStats& stats) { return stats.splats; });
  row.pairs = mean(frames, [](const FrameStats& stats) { return stats.pairs_after; });
  row.bytes = mean(frames, bytes_moved);
}

double median_tau(const std::vector<FrameStats>& frames) {
  std::vector<double> taus;
  taus.reserve(frames.size());
  for (const FrameStats& stats : frames) taus.push_back(stats.tau);
  return percentile(taus, 0.5);
}

// From the first frame on, without the view's making. Sensors are read every tenth of a second or
// so: of less than a second there is no figure.
class FrameEnergy {
 public:
  explicit FrameEnergy(EnergyMeter* meter) : meter_(meter) {}

  void frame(size_t drawn) {
    last_ = drawn;
    if (begin_) return;
    begin_ = drawn;
    watch_ = Stopwatch();
    if (meter_ != nullptr) before_ = meter_->joules();
  }
  std::optional<double> joules_a_frame() {
    constexpr double kLeast = 1000;  // milliseconds
    if (!before_ || last_ == *begin_ || watch_.milliseconds() < kLeast) return std::nullopt;
    const std::optional<double> after = meter_->joules();
    if (!after) return std::nullopt;
    return (*after - *before_) / static_cast<double>(last_ - *begin_);
  }

 private:
  EnergyMeter* meter_;
  std::optional<size_t> begin_;
  size_t last_ = 0;
  Stopwatch watch_;
  std::optional<double> before_;
};

std::vector<ComparedFrame> compared_frames(const ReportPlan& plan) {
  std::vector<ComparedFrame> frames;
  for (const size_t i : plan.compared) frames.push_back({i, plan.path[i].eyes[0].camera.width});
  return frames;
}

}  // namespace

size_t Measurement::frames_drawn() const {
  return FramePath{plan_.path, plan_.repeats, {}, false}.frames_drawn();
}

ReportRow Measurement::run(const ReportCase& is, const std::function<void(size_t)>& frame_done) {
  const FrameMaker maker{backend_, scenes_.get(is.storage, is.sh_degree), workers_};
  FramePath path{plan_.path, plan_.repeats, {}, false};
  for (FrameInput& frame : path.frames) frame.tau = is.tau;
  if (is.time_budget > 0) path.time_budget = TimeBudgetDesc{is.time_budget};
  ReportRow row;
  row.is = is;
  FrameEnergy energy(energy_);
  const FrameRun timed = run_frames(maker, is.desc, path, [&](size_t drawn) {
    energy.frame(drawn);
    frame_done(drawn);
  });
  row.joules = energy.joules_a_frame();
  set_times(timed.timed, row);
  row.tau = is.time_budget > 0 ? median_tau(timed.timed) : is.tau;
  for (FrameInput& frame : path.frames) frame.tau = row.tau;
  const auto images = draw_images(maker, is.desc, path.frames, plan_.compared);
  pictures_.image = images.front();
  const std::vector<ComparedFrame> frames = compared_frames(plan_);
  const std::vector<double> taus(frames.size(), row.tau);
  row.same = compare_images(images, references_.of({is.desc.lod, taus}), frames, workers_);
  row.all = compare_images(images, references_.of({}), frames, workers_, &pictures_.difference);
  return row;
}

}  // namespace voyager::tools
