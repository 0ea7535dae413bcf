// A walk through a streamed scene at the pace of a headset: what each frame took, and what it
// showed coarser than τ. Then whoever walks stands still for three seconds, turns round, and stands
// still until nothing is coarser than τ.
//   stream_walk SCENE CAMERAS.json MEGABYTES [FPS] [WxH] [TAU] [SECONDS] [READERS]
// The cameras are a path that is walked at 1.4 m a second of its length, back and forth.
// A frame counts as whole by the stream's last plan: what came into sight since is not counted.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "runtime/base/error.h"
#include "streamed_view.h"

namespace {

using Clock = std::chrono::steady_clock;
using voyager::tools::Camera;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double distance(const Camera& a, const Camera& b) {
  double squared = 0;
  for (int i = 0; i < 3; ++i) {
    const double d = a.pose.position[i] - b.pose.position[i];
    squared += d * d;
  }
  return std::sqrt(squared);
}

// The path by its length; each camera's orientation holds until the next.
class Path {
 public:
  Path(std::vector<Camera> cameras, const std::string& file) : cameras_(std::move(cameras)) {
    if (cameras_.size() < 2)
      refuse(file, std::to_string(cameras_.size()) + " camera", "a path of at least two");
    at_.push_back(0);
    for (size_t i = 1; i < cameras_.size(); ++i)
      at_.push_back(at_.back() + distance(cameras_[i - 1], cameras_[i]));
    if (!(at_.back() > 0)) refuse(file, "all cameras in one place", "a path longer than 0 metres");
  }
  Camera at(double metres) const {
    const double length = at_.back();
    double along = std::fmod(metres, 2 * length);
    if (along > length) along = 2 * length - along;
    const auto after = std::upper_bound(at_.begin() + 1, at_.end() - 1, along);
    const auto i = static_cast<size_t>(after - at_.begin());
    const double t =
        std::clamp((along - at_[i - 1]) / std::max(1e-9, at_[i] - at_[i - 1]), 0.0, 1.0);
    Camera camera = cameras_[i - 1];
    for (int k = 0; k < 3; ++k)
      camera.pose.position[k] += t * (cameras_[i].pose.position[k] - camera.pose.position[k]);
    return camera;
  }

 private:
  [[noreturn]] static void refuse(const std::string& file, const std::string& found,
                                  const std::string& expected) {
    throw voyager::Error(voyager::ErrorCode::refused_input,
                         file + ": found " + found + ", expected " + expected);
  }

  std::vector<Camera> cameras_;
  std::vector<double> at_;
};

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(q * static_cast<double>(values.size() - 1))];
}

long peak_kilobytes() {
  long found = 0;
  if (FILE* status = std::fopen("/proc/self/status", "r")) {
    char line[256];
    while (std::fgets(line, sizeof line, status))
      if (std::sscanf(line, "VmHWM: %ld", &found) == 1) break;
    std::fclose(status);
  }
  return found;
}

// No fallback was drawn, or the stream's last plan found all resident that was seen then. What came
// into sight since that plan is not counted.
bool is_whole(const VoyFrameStats& frame, const VoyStreamingStats& streaming) {
  return frame.nodesUnrefined == 0 || streaming.seenMissingChunks == 0;
}

struct Turn {
  // Of frames from the turn's start to a second after its end. search: what that stage takes of ms.
  std::vector<double> ms, search, wall;
  double whole_after = 0;  // seconds from the turn's end to the end of the last coarse frame
  size_t coarse_turning = 0, coarse_after = 0;
  bool ended_whole = false;
};

// Three seconds of standing, half a second for 180 degrees, and standing: three seconds, or until
// all was whole for a second, but twenty at most.
Turn turn_round(voyager::bench::StreamedView& streamed, const Camera& from, double fps) {
  Turn found;
  const auto standing = static_cast<size_t>(3 * fps), turning = static_cast<size_t>(fps / 2);
  const auto most = standing + turning + static_cast<size_t>(20 * fps);
  size_t whole = 0;  // frames on end
  auto next = Clock::now(), ended = next;
  for (size_t i = 0; i <= 2 * standing + turning || (static_cast<double>(whole) < fps && i < most);
       ++i) {
    const double share =
        static_cast<double>(i - std::min(i, standing)) / static_cast<double>(turning);
    const auto begun = Clock::now();
    streamed.render(voyager::bench::turned(from, 3.14159265358979 * std::min(1.0, share)));
    const VoyFrameStats stats = streamed.view.stats();
    if (i > standing && static_cast<double>(i - standing) <= static_cast<double>(turning) + fps) {
      found.wall.push_back(1e3 * seconds_since(begun));
      found.ms.push_back(stats.millisecondsTotal);
      found.search.push_back(stats.milliseconds[VOY_STAGE_SEARCH]);
    }
    found.ended_whole = is_whole(stats, streamed.scene.streaming_stats());
    whole = found.ended_whole ? whole + 1 : 0;
    if (i == standing + turning) ended = Clock::now();
    if (i > standing && !found.ended_whole) {
      (i > standing + turning ? found.coarse_after : found.coarse_turning)++;
      found.whole_after = i > standing + turning ? seconds_since(ended) : 0;
    }
    next += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / fps));
    std::this_thread::sleep_until(next);
  }
  return found;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 4) {
    std::fprintf(
        stderr, "stream_walk SCENE CAMERAS.json MEGABYTES [FPS] [WxH] [TAU] [SECONDS] [READERS]\n");
    return 1;
  }
  const double megabytes = std::atof(argv[3]), fps = argc > 4 ? std::atof(argv[4]) : 60;
  unsigned width = 1920, height = 1080;
  if (argc > 5) std::sscanf(argv[5], "%ux%u", &width, &height);
  const double tau = argc > 6 ? std::atof(argv[6]) : 3,
               seconds = argc > 7 ? std::atof(argv[7]) : 30;
  const int readers = argc > 8 ? std::atoi(argv[8]) : 0;
  std::vector<Camera> cameras = voyager::tools::read_cameras(argv[2]);
  for (Camera& camera : cameras) camera = camera.resized(width, height);
  const Path path(cameras, argv[2]);

  const auto first_of_all = Clock::now();
  const voy::Device device = voyager::bench::streaming_device(megabytes);
  const double device_made = seconds_since(first_of_all);
  // Without a viewer only the top of the tree is read, and what comes next in the file.
  const auto alone = Clock::now();
  auto scene = std::make_unique<voy::Scene>(voyager::bench::StreamedView::open(
      device, argv[1], megabytes, nullptr, static_cast<uint32_t>(readers)));
  const double opened_alone = seconds_since(alone);
  scene.reset();
  const auto start = Clock::now();
  const Camera first = path.at(0);
  voyager::bench::StreamedView streamed(device, argv[1], megabytes, first.pose.position, width,
                                        height, tau, static_cast<uint32_t>(readers));
  const double opened = seconds_since(start);

  const size_t frames = std::max(static_cast<size_t>(seconds * fps), size_t{1});
  std::vector<double> ms, search, wall, missing, cut, seen, unseen;
  double first_image = 0, settled = 0;
  size_t coarse = 0;
  VoyStreamingStats before = VOY_STREAMING_STATS_INIT;
  // Five seconds to settle, and then the walk.
  const auto settling = static_cast<size_t>(5 * fps);
  auto next = Clock::now();
  for (size_t i = 0; i < settling + frames; ++i) {
    const double metres = i < settling ? 0 : 1.4 * static_cast<double>(i - settling) / fps;
    const Camera camera = path.at(metres);
    const auto begun = Clock::now();
    streamed.render(camera);
    const VoyFrameStats stats = streamed.view.stats();
    if (i == 0) first_image = seconds_since(start);
    const VoyStreamingStats now = streamed.scene.streaming_stats();
    const bool whole = is_whole(stats, now);
    // At first nothing is known to be missing, as nothing has been looked at.
    if (i < settling && !whole) settled = seconds_since(start);
    if (i + 1 == settling && !whole) settled = -1;
    if (i == settling) before = now;
    if (i >= settling) {
      wall.push_back(1e3 * seconds_since(begun));
      ms.push_back(stats.millisecondsTotal);
      search.push_back(stats.milliseconds[VOY_STAGE_SEARCH]);
      missing.push_back(static_cast<double>(stats.nodesUnrefined));
      cut.push_back(static_cast<double>(stats.cutSize));
      coarse += !whole;
      seen.push_back(static_cast<double>(now.seenChunks));
      unseen.push_back(static_cast<double>(now.seenMissingChunks));
    }
    next += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / fps));
    std::this_thread::sleep_until(next);
  }
  const VoyStreamingStats after = streamed.scene.streaming_stats();
  const Turn turn = turn_round(streamed, path.at(1.4 * static_cast<double>(frames) / fps), fps);
  const VoySceneInfo info = streamed.scene.info();
  const double metres = 1.4 * static_cast<double>(frames) / fps;
  std::printf(
      "{\"device\": \"%s\", \"gaussians\": %llu, \"sh_degree\": %u, \"budget_mb\": %g, "
      "\"pool_mb\": %.1f, \"slots\": %llu, \"resident\": %llu, \"needed_chunks\": %llu,\n"
      " \"device_s\": %.2f, \"opened_alone_s\": %.2f, \"opened_s\": %.2f, \"first_image_s\": %.2f, "
      "\"settled_s\": %.2f, "
      "\"frames\": %zu, \"coarse_frames\": %zu, \"missing_p50\": %.0f, \"missing_p99\": %.0f, "
      "\"cut_p50\": %.0f, \"seen_p50\": %.0f, \"seen_missing_p50\": %.0f, \"seen_missing_p99\": "
      "%.0f,\n"
      " \"ms_p50\": %.2f, \"ms_p99\": %.2f, \"search_p50\": %.3f, \"search_p99\": %.3f, "
      "\"wall_p50\": %.2f, \"wall_p99\": %.2f, "
      "\"wall_max\": %.2f, \"read_mb_a_metre\": %.3f, \"late\": %llu, \"arrived\": %llu, "
      "\"evicted\": %llu, \"failures\": %llu, \"peak_host_mb\": %.0f,\n"
      " \"turn_coarse_frames\": %zu, \"after_turn_coarse_frames\": %zu, "
      "\"after_turn_coarse_s\": %.2f, \"after_turn_whole\": %s, \"turn_ms_p50\": %.2f, "
      "\"turn_ms_p99\": %.2f, \"turn_search_p50\": %.3f, \"turn_search_p99\": %.3f, "
      "\"turn_wall_p50\": %.2f, \"turn_wall_p99\": %.2f}\n",
      device.capabilities().deviceName, static_cast<unsigned long long>(info.gaussianCount),
      info.shDegree, megabytes, static_cast<double>(after.budgetBytes) / 1e6,
      static_cast<unsigned long long>(after.chunkSlots),
      static_cast<unsigned long long>(after.residentChunks),
      static_cast<unsigned long long>(after.neededChunks), device_made, opened_alone, opened,
      first_image, settled, frames, coarse, quantile(missing, 0.5), quantile(missing, 0.99),
      quantile(cut, 0.5), quantile(seen, 0.5), quantile(unseen, 0.5), quantile(unseen, 0.99),
      quantile(ms, 0.5), quantile(ms, 0.99), quantile(search, 0.5), quantile(search, 0.99),
      quantile(wall, 0.5), quantile(wall, 0.99), quantile(wall, 1),
      static_cast<double>(after.bytesRead - before.bytesRead) / 1e6 / metres,
      static_cast<unsigned long long>(after.lateChunks - before.lateChunks),
      static_cast<unsigned long long>(after.arrivedChunks - before.arrivedChunks),
      static_cast<unsigned long long>(after.evictedChunks - before.evictedChunks),
      static_cast<unsigned long long>(after.failures), static_cast<double>(peak_kilobytes()) / 1e3,
      turn.coarse_turning, turn.coarse_after, turn.whole_after, turn.ended_whole ? "true" : "false",
      quantile(turn.ms, 0.5), quantile(turn.ms, 0.99), quantile(turn.search, 0.5),
      quantile(turn.search, 0.99), quantile(turn.wall, 0.5), quantile(turn.wall, 0.99));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "stream_walk: %s\n", error.what());
  return 1;
}
