#include "tools/report/measure.h"

#include "tools/metrics/flip.h"
#include "tools/metrics/image_error.h"
#include "tools/metrics/popping.h"
#include "tools/metrics/ssim.h"
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
  const auto before = energy_ == nullptr ? std::nullopt : energy_->joules();
  const FrameRun timed = run_frames(maker, is.desc, path, frame_done);
  const auto after = energy_ == nullptr ? std::nullopt : energy_->joules();
  if (before && after) row.joules = (*after - *before) / static_cast<double>(path.frames_drawn());
  set_times(timed.timed, row);
  row.tau = is.time_budget > 0 ? median_tau(timed.timed) : is.tau;
  for (FrameInput& frame : path.frames) frame.tau = row.tau;
  const auto images = draw_images(maker, is.desc, path.frames, plan_.compared);
  pictures_.image = images.front();
  const bool cut = is.desc.lod == Lod::cut;
  row.same = compare(images, cut ? std::optional(row.tau) : std::nullopt, false);
  row.all = compare(images, std::nullopt, true);
  return row;
}

ReportError Measurement::compare(const std::vector<RgbaImage>& images, std::optional<double> tau,
                                 bool keep_difference) {
  std::vector<RgbaImage> expected;
  ReportError error;
  double ssims = 0, changes = 0;
  size_t changes_seen = 0;
  bool has_ssim = true;
  for (size_t i = 0; i < images.size(); ++i) {
    const size_t frame = plan_.compared[i];
    expected.push_back(references_.of(frame, tau));
    const size_t width = references_.width(frame);
    const size_t height = images[i].size() / 4 / width;
    has_ssim = has_ssim && std::min(width, height) >= kSsimWindow;
    if (has_ssim) ssims += ssim(images[i], expected[i], width);
    Flip found = flip(images[i], expected[i], width);
    error.flip += found.mean / static_cast<double>(images.size());
    if (keep_difference && i == 0) pictures_.difference = std::move(found.map);
    if (i == 0 || plan_.compared[i - 1] + 1 != frame) continue;
    Popping popping;
    popping.add(images[i - 1], expected[i - 1]);
    popping.add(images[i], expected[i]);
    changes += popping.mean();
    ++changes_seen;
  }
  const ImageError found = image_error(images, expected);
  error.psnr = found.psnr;
  error.largest = found.largest;
  error.p999 = found.p999;
  error.not_finite = found.not_finite;
  if (has_ssim) error.ssim = ssims / static_cast<double>(images.size());
  if (changes_seen > 0) error.popping = changes / static_cast<double>(changes_seen);
  return error;
}

}  // namespace voyager::tools
