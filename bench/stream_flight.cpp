// A random flight through a streamed scene: what frames took, and which took longer than those
// around them, with what they did. It lists late frames, except those after a
// jump and those whose search took longer because chunks arrived.
//   stream_flight SCENE CAMERAS.json MEGABYTES [FRAMES] [WxH] [TAU] [SEED] [FPS]
// From a camera of the file towards the next one, drawn at random, at 1 to 15 m a second, with a
// head that turns; now and then a jump. The same arguments fly the same way.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "streamed_view.h"
#include "voyager/voyager_experiment.h"

namespace {

using Clock = std::chrono::steady_clock;
using voyager::Vec3d;
using voyager::tools::Camera;

constexpr size_t kAround = 50;        // frames on either side that a frame is compared with
constexpr double kLate = 2;           // times their median
constexpr size_t kJumpEvery = 1'000;  // frames

class Flight {
 public:
  Flight(const std::vector<Camera>& cameras, uint64_t seed, double fps, unsigned width,
         unsigned height)
      : random_(seed), cameras_(cameras), step_(1 / fps), width_(width), height_(height) {
    at_ = goal_ = place();
  }

  bool jumps(size_t frame) const { return frame % kJumpEvery == 0; }

  Camera next(size_t frame) {
    if (jumps(frame)) at_ = goal_ = place();
    Vec3d way = goal_ - at_;
    if (std::sqrt(dot(way, way)) < 1) {
      goal_ = place();
      speed_ = uniform(1, 15);
      turn_ = uniform(-1.5, 1.5);
      way = goal_ - at_;
    }
    const double left = std::sqrt(dot(way, way));
    const double metres = std::min(left, speed_ * step_);
    if (left > 0) at_ = at_ + (metres / left) * way;
    yaw_ += turn_ * step_;
    const double pitch = 0.3 * std::sin(0.7 * yaw_);
    const Vec3d forward{std::cos(yaw_) * std::cos(pitch), std::sin(pitch),
                        std::sin(yaw_) * std::cos(pitch)};
    const Vec3d right{-std::sin(yaw_), 0, std::cos(yaw_)};
    return voyager::tools::looking(at_, right, forward, width_, height_, 0.6 * width_);
  }

 private:
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  Vec3d place() {
    const size_t i = std::uniform_int_distribution<size_t>(0, cameras_.size() - 1)(random_);
    const double* p = cameras_[i].pose.position;
    return {p[0], p[1], p[2]};
  }

  std::mt19937_64 random_;
  const std::vector<Camera>& cameras_;
  double step_, speed_ = 1.4, yaw_ = 0, turn_ = 0.3;
  unsigned width_, height_;
  Vec3d at_{}, goal_{};
};

struct Taken {
  double device, call;  // milliseconds; the device's without the copy to the host
  double stages[VOY_MAX_STAGES];
  uint64_t entered, arrived, pairs;
  size_t since_jump;
  uint32_t redraws;
  bool anew;  // the search went through the whole tree
};

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(q * static_cast<double>(values.size() - 1))];
}

// Of the frames around one, of what `of` reads.
template <class Of>
double median_around(const std::vector<Taken>& frames, size_t frame, const Of& of) {
  std::vector<double> around;
  for (size_t i = frame - std::min(frame, kAround); i < std::min(frames.size(), frame + kAround);
       ++i)
    around.push_back(of(frames[i]));
  return quantile(around, 0.5);
}

// The stage that took longer, and by how many milliseconds.
struct Longer {
  int stage = 0;
  double by = -1;
};

Longer longer_stage(const std::vector<Taken>& frames, size_t frame) {
  Longer most;
  for (int stage = 0; stage < VOY_STAGE_RESOLVE; ++stage) {
    const double usual =
        median_around(frames, frame, [&](const Taken& of) { return of.stages[stage]; });
    const double by = frames[frame].stages[stage] - usual;
    if (by > most.by) most = {stage, by};
  }
  return most;
}

long resident_kilobytes() {
  long found = 0;
  if (FILE* status = std::fopen("/proc/self/status", "r")) {
    char line[256];
    while (std::fgets(line, sizeof line, status))
      if (std::sscanf(line, "VmRSS: %ld", &found) == 1) break;
    std::fclose(status);
  }
  return found;
}

void print(const std::vector<Taken>& frames) {
  std::vector<double> device, call;
  for (const Taken& frame : frames) device.push_back(frame.device), call.push_back(frame.call);
  std::printf(
      "frames %zu, device p50 %.3f p99 %.3f p99.9 %.3f max %.3f ms, call p50 %.3f p99 %.3f max "
      "%.3f ms\n",
      frames.size(), quantile(device, 0.5), quantile(device, 0.99), quantile(device, 0.999),
      quantile(device, 1), quantile(call, 0.5), quantile(call, 0.99), quantile(call, 1));
  size_t late = 0, after_jumps = 0, by_stage[VOY_STAGE_RESOLVE] = {}, with_chunks = 0;
  std::vector<std::string> others;  // that neither a search nor a jump made late
  for (size_t i = 0; i < frames.size(); ++i) {
    const double usual = median_around(frames, i, [](const Taken& of) { return of.device; });
    if (frames[i].device <= kLate * usual) continue;
    ++late;
    if (frames[i].since_jump < 3) {
      ++after_jumps;
      continue;
    }
    const Longer longer = longer_stage(frames, i);
    ++by_stage[longer.stage];
    with_chunks += frames[i].arrived != 0;
    if (longer.stage == VOY_STAGE_SEARCH && frames[i].arrived != 0) continue;
    char line[256];
    std::snprintf(
        line, sizeof line,
        "  frame %zu, %zu after a jump: %.3f ms, usually %.3f; %s %.3f longer; %llu chunks "
        "came, %llu nodes entered, %llu pairs%s%s\n",
        i, frames[i].since_jump, frames[i].device, usual,
        voyStageName(static_cast<VoyStage>(longer.stage)), longer.by,
        static_cast<unsigned long long>(frames[i].arrived),
        static_cast<unsigned long long>(frames[i].entered),
        static_cast<unsigned long long>(frames[i].pairs),
        frames[i].anew ? "; searched from the top" : "",
        frames[i].redraws != 0 ? "; drawn again with larger buffers" : "");
    others.emplace_back(line);
  }
  std::printf(
      "late %zu: %zu within two frames after a jump; of the others, by the stage that grew:", late,
      after_jumps);
  for (int s = 0; s < VOY_STAGE_RESOLVE; ++s)
    std::printf(" %s %zu", voyStageName(static_cast<VoyStage>(s)), by_stage[s]);
  std::printf("; %zu of them with chunks that came\n", with_chunks);
  for (const std::string& line : others) std::fputs(line.c_str(), stdout);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 4 || (argc > 4 && std::atof(argv[4]) < 1)) {
    std::fprintf(stderr,
                 "stream_flight SCENE CAMERAS.json MEGABYTES [FRAMES] [WxH] [TAU] [SEED] [FPS]\n");
    return 1;
  }
  const auto number = [&](int i, double otherwise) {
    return argc > i ? std::atof(argv[i]) : otherwise;
  };
  const double megabytes = number(3, 0), tau = number(6, 3), fps = number(8, 60);
  const auto count = static_cast<size_t>(number(4, 10'000));
  unsigned width = 1920, height = 1080;
  if (argc > 5) std::sscanf(argv[5], "%ux%u", &width, &height);
  const std::vector<Camera> cameras = voyager::tools::read_cameras(argv[2]);
  Flight flight(cameras, static_cast<uint64_t>(number(7, 1)), fps, width, height);

  const voy::Device device = voyager::bench::streaming_device(megabytes);
  voyager::bench::StreamedView streamed(device, argv[1], megabytes, nullptr, width, height, tau);

  std::vector<Taken> frames(count);  // at once: what grows later is not this list
  uint64_t arrived_before = 0;
  std::vector<long> kilobytes;  // after each tenth
  size_t since_jump = 0;
  auto next = Clock::now();
  for (size_t i = 0; i < count; ++i) {
    since_jump = flight.jumps(i) ? 0 : since_jump + 1;
    const Camera camera = flight.next(i);
    const auto begun = Clock::now();
    streamed.render(camera);
    const std::chrono::duration<double, std::milli> call = Clock::now() - begun;
    VoyExperimentStats experiment = VOY_EXPERIMENT_STATS_INIT;
    VoyFrameStats stats = VOY_FRAME_STATS_INIT;
    stats.next = &experiment;
    voy::check(voyGetFrameStats(streamed.view.get(), &stats));
    const uint64_t arrived = streamed.scene.streaming_stats().arrivedChunks;
    Taken taken{stats.millisecondsTotal - stats.milliseconds[VOY_STAGE_RESOLVE],
                call.count(),
                {},
                stats.nodesEntered,
                arrived - arrived_before,
                stats.pairsAfterFilter,
                since_jump,
                experiment.redrawCount,
                experiment.search == VOY_SEARCH_STREAMING};
    std::copy_n(stats.milliseconds, VOY_MAX_STAGES, taken.stages);
    arrived_before = arrived;
    frames[i] = taken;
    if ((i + 1) % std::max<size_t>(1, count / 10) == 0) kilobytes.push_back(resident_kilobytes());
    next += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / fps));
    std::this_thread::sleep_until(next);
  }
  print(frames);
  std::printf("host memory after each tenth, MB:");
  for (const long size : kilobytes) std::printf(" %.0f", static_cast<double>(size) / 1e3);
  std::printf("\n");
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "stream_flight: %s\n", error.what());
  return 1;
}
