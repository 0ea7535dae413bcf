#include "tools/report/measure.h"

#include "runtime/base/clock.h"
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

// Of one image.
struct Difference {
  Flip flip;
  std::optional<double> ssim;
};

Difference difference(const RgbaImage& image, const RgbaImage& expected, size_t width) {
  Difference found{flip(image, expected, width), std::nullopt};
  if (std::min(width, image.size() / 4 / width) >= kSsimWindow)
    found.ssim = ssim(image, expected, width);
  return found;
}

// Means; no SSIM where one image has none.
ReportError sum_up(const std::vector<Difference>& found) {
  const auto count = static_cast<double>(found.size());
  ReportError error;
  error.ssim = 0.0;
  for (const Difference& of : found) {
    error.flip += of.flip.mean / count;
    error.ssim =
        error.ssim && of.ssim ? std::optional(*error.ssim + *of.ssim / count) : std::nullopt;
  }
  return error;
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
  row.same = compare(images, {is.desc.lod, row.tau}, false);
  row.all = compare(images, {}, true);
  return row;
}

ReportError Measurement::compare(const std::vector<RgbaImage>& images, const Detail& detail,
                                 bool keep_difference) {
  std::vector<RgbaImage> expected;
  for (const size_t frame : plan_.compared) expected.push_back(references_.of(frame, detail));
  std::vector<Difference> found(images.size());
  workers_.for_blocks(images.size(), 1, [&](size_t i, size_t) {
    found[i] = difference(images[i], expected[i], references_.width(plan_.compared[i]));
    if (!keep_difference || i != 0) found[i].flip.map = {};
  });
  ReportError error = sum_up(found);
  if (keep_difference) pictures_.difference = std::move(found[0].flip.map);
  size_t changes = 0;
  for (size_t i = 1; i < images.size(); ++i) {
    if (plan_.compared[i - 1] + 1 != plan_.compared[i]) continue;
    Popping popping;
    popping.add(images[i - 1], expected[i - 1]);
    popping.add(images[i], expected[i]);
    error.popping += popping.mean();
    ++changes;
  }
  if (changes > 0) error.popping /= static_cast<double>(changes);
  const ImageError pixels = image_error(images, expected);
  error.psnr = pixels.psnr;
  error.largest = pixels.largest;
  error.p999 = pixels.p999;
  error.not_finite = pixels.not_finite;
  return error;
}

}  // namespace voyager::tools
