// A walk through a streamed scene at the pace of a headset: what each frame took, and what it
// showed coarser than τ.
//   stream_walk SCENE CAMERAS.json MEGABYTES [FPS] [WxH] [TAU] [SECONDS]
// The cameras are a path that is walked at 1.4 m a second of its length, back and forth.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "tools/cameras.h"
#include "voyager/voyager.hpp"

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
  explicit Path(std::vector<Camera> cameras) : cameras_(std::move(cameras)) {
    at_.push_back(0);
    for (size_t i = 1; i < cameras_.size(); ++i)
      at_.push_back(at_.back() + distance(cameras_[i - 1], cameras_[i]));
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

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 4) {
    std::fprintf(stderr, "stream_walk SCENE CAMERAS.json MEGABYTES [FPS] [WxH] [TAU] [SECONDS]\n");
    return 1;
  }
  const double megabytes = std::atof(argv[3]), fps = argc > 4 ? std::atof(argv[4]) : 60;
  unsigned width = 1920, height = 1080;
  if (argc > 5) std::sscanf(argv[5], "%ux%u", &width, &height);
  const double tau = argc > 6 ? std::atof(argv[6]) : 3,
               seconds = argc > 7 ? std::atof(argv[7]) : 30;
  std::vector<Camera> cameras = voyager::tools::read_cameras(argv[2]);
  for (Camera& camera : cameras) camera = camera.resized(width, height);
  const Path path(cameras);

  const auto start = Clock::now();
  VoyDeviceDesc device_desc = VOY_DEVICE_DESC_INIT;
  device_desc.deviceMemoryBudget = static_cast<uint64_t>(megabytes * 1e6);
  const voy::Device device = voy::Device::create(device_desc);
  const double device_made = seconds_since(start);
  VoySceneStreaming streaming = VOY_SCENE_STREAMING_INIT;
  streaming.memoryBudget = device_desc.deviceMemoryBudget;
  const Camera first = path.at(0);
  streaming.startPosition = first.pose.position;
  VoySceneDesc scene_desc = VOY_SCENE_DESC_INIT;
  scene_desc.next = &streaming;
  scene_desc.path = argv[1];
  const voy::Scene scene = device.open_scene(scene_desc);
  const double opened = seconds_since(start);
  VoyScene handle = scene.get();
  VoyViewDesc view_desc = VOY_VIEW_DESC_INIT;
  view_desc.instanceCount = 1;
  view_desc.scenes = &handle;
  view_desc.maxWidth = width;
  view_desc.maxHeight = height;
  view_desc.tau = tau;
  voy::View view = device.create_view(view_desc);
  std::vector<uint8_t> pixels(size_t{4} * width * height);
  VoyTargetDesc target_desc = VOY_TARGET_DESC_INIT;
  target_desc.width = width;
  target_desc.height = height;
  target_desc.color = pixels.data();
  const voy::Target target = device.create_target(target_desc);

  const auto frames = static_cast<size_t>(seconds * fps);
  std::vector<double> ms, wall, missing, cut, seen, unseen;
  double first_image = 0, settled = 0;
  size_t coarse = 0;
  VoyStreamingStats before = VOY_STREAMING_STATS_INIT;
  // Five seconds to settle, and then the walk.
  const auto settling = static_cast<size_t>(5 * fps);
  auto next = Clock::now();
  for (size_t i = 0; i < settling + frames; ++i) {
    const double metres = i < settling ? 0 : 1.4 * static_cast<double>(i - settling) / fps;
    const Camera camera = path.at(metres);
    VoyFrameEye eye = VOY_FRAME_EYE_INIT;
    eye.pose = camera.pose;
    eye.frustum = camera.frustum();
    eye.target = target.get();
    VoyFrame frame = VOY_FRAME_INIT;
    frame.eyeCount = 1;
    frame.eyes = &eye;
    const auto begun = Clock::now();
    view.render(frame);
    const VoyFrameStats stats = view.stats();
    if (i == 0) first_image = seconds_since(start);
    VoyStreamingStats streamed = VOY_STREAMING_STATS_INIT;
    voyGetStreamingStats(handle, &streamed);
    const bool whole = stats.nodesUnrefined == 0 || streamed.seenMissingChunks == 0;
    if (settled == 0 && i > 10 && whole) settled = seconds_since(start);
    if (i == settling) voyGetStreamingStats(handle, &before);
    if (i >= settling) {
      wall.push_back(1e3 * seconds_since(begun));
      ms.push_back(stats.millisecondsTotal);
      missing.push_back(static_cast<double>(stats.nodesUnrefined));
      cut.push_back(static_cast<double>(stats.cutSize));
      coarse += !whole;
      seen.push_back(static_cast<double>(streamed.seenChunks));
      unseen.push_back(static_cast<double>(streamed.seenMissingChunks));
    }
    next += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / fps));
    std::this_thread::sleep_until(next);
  }
  VoyStreamingStats after = VOY_STREAMING_STATS_INIT;
  voyGetStreamingStats(handle, &after);
  const VoySceneInfo info = scene.info();
  const double metres = 1.4 * static_cast<double>(frames) / fps;
  std::printf(
      "{\"device\": \"%s\", \"gaussians\": %llu, \"sh_degree\": %u, \"budget_mb\": %g, "
      "\"pool_mb\": %.1f, \"slots\": %llu, \"resident\": %llu, \"needed_chunks\": %llu,\n"
      " \"device_s\": %.2f, \"opened_s\": %.2f, \"first_image_s\": %.2f, \"settled_s\": %.2f, "
      "\"frames\": %zu, \"coarse_frames\": %zu, \"missing_p50\": %.0f, \"missing_p99\": %.0f, "
      "\"cut_p50\": %.0f, \"seen_p50\": %.0f, \"seen_missing_p50\": %.0f, \"seen_missing_p99\": "
      "%.0f,\n"
      " \"ms_p50\": %.2f, \"ms_p99\": %.2f, \"wall_p50\": %.2f, \"wall_p99\": %.2f, "
      "\"wall_max\": %.2f, \"read_mb_a_metre\": %.3f, \"late\": %llu, \"arrived\": %llu, "
      "\"evicted\": %llu, \"failures\": %llu, \"peak_host_mb\": %.0f}\n",
      device.capabilities().deviceName, static_cast<unsigned long long>(info.gaussianCount),
      info.shDegree, megabytes, static_cast<double>(after.budgetBytes) / 1e6,
      static_cast<unsigned long long>(after.chunkSlots),
      static_cast<unsigned long long>(after.residentChunks),
      static_cast<unsigned long long>(after.neededChunks), device_made, opened, first_image,
      settled, frames, coarse, quantile(missing, 0.5), quantile(missing, 0.99), quantile(cut, 0.5),
      quantile(seen, 0.5), quantile(unseen, 0.5), quantile(unseen, 0.99), quantile(ms, 0.5),
      quantile(ms, 0.99), quantile(wall, 0.5), quantile(wall, 0.99), quantile(wall, 1),
      static_cast<double>(after.bytesRead - before.bytesRead) / 1e6 / metres,
      static_cast<unsigned long long>(after.lateChunks - before.lateChunks),
      static_cast<unsigned long long>(after.arrivedChunks - before.arrivedChunks),
      static_cast<unsigned long long>(after.evictedChunks - before.evictedChunks),
      static_cast<unsigned long long>(after.failures), static_cast<double>(peak_kilobytes()) / 1e3);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "stream_walk: %s\n", error.what());
  return 1;
}
