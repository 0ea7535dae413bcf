// What a viewer who stands still sees while a scene comes: seconds until its picture is, for good,
// as near as that to the one with nothing missing; and the same once it has turned round at once.
//   stream_quality SCENE CAMERAS.json MEGABYTES [CAMERA] [WxH] [TAU] [SECONDS] [READERS]
// SCENE may be a URL. The clock starts before the scene is opened, with the camera as its start.
// Each last picture stands for the whole one: if it is not (SECONDS, 120), "missing" is not 0.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "streamed_view.h"

namespace {

using Clock = std::chrono::steady_clock;

// Nothing may be missing for so long, in seconds: before a plan nobody knows that something is.
constexpr double kWhole = 1;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Shown {
  double at;  // seconds
  std::vector<uint8_t> pixels;
};

double psnr(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  double sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    if (i % 4 == 3) continue;
    const double d = static_cast<double>(a[i]) - static_cast<double>(b[i]);
    sum += d * d;
    ++count;
  }
  return sum == 0 ? std::numeric_limits<double>::infinity()
                  : 10 * std::log10(255.0 * 255.0 * static_cast<double>(count) / sum);
}

// From then on no picture is worse than `least`, in dB.
double seconds_until(const std::vector<Shown>& shown, double least) {
  size_t first = shown.size() - 1;
  while (first > 0 && psnr(shown[first - 1].pixels, shown.back().pixels) >= least) --first;
  return shown[first].at;
}

// Draws until nothing has been missing for a while, but no longer than `longest` seconds, and
// prints what was seen since `start`.
void watch(voyager::bench::StreamedView& streamed, const voyager::tools::Camera& camera,
           Clock::time_point start, double longest) {
  std::vector<Shown> shown;
  double whole = 0;  // since when nothing is missing
  int in_a_row = 0;  // pictures of which nothing was
  do {
    streamed.render(camera);
    const auto now = streamed.scene.streaming_stats();
    const bool missing = streamed.view.stats().nodesUnrefined != 0 && now.seenMissingChunks != 0;
    shown.push_back({seconds_since(start), streamed.pixels()});
    in_a_row = missing ? 0 : in_a_row + 1;
    if (in_a_row <= 1) whole = shown.back().at;
  } while ((in_a_row < 3 || seconds_since(start) < whole + kWhole) &&
           seconds_since(start) < longest);
  const VoyStreamingStats stats = streamed.scene.streaming_stats();
  std::printf("\"first_image_s\": %.2f, \"first_db\": %.1f", shown.front().at,
              psnr(shown.front().pixels, shown.back().pixels));
  for (const int least : {20, 25, 30, 35, 40, 50})
    std::printf(", \"db_%d_s\": %.2f", least, seconds_until(shown, least));
  std::printf(", \"whole_s\": %.2f, \"frames\": %zu, \"missing\": %llu, \"read_mb\": %.1f", whole,
              shown.size(), static_cast<unsigned long long>(stats.seenMissingChunks),
              static_cast<double>(stats.bytesRead) / 1e6);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 4) {
    std::fprintf(
        stderr,
        "stream_quality SCENE CAMERAS.json MEGABYTES [CAMERA] [WxH] [TAU] [SECONDS] [READERS]\n");
    return 1;
  }
  const double megabytes = std::atof(argv[3]);
  const size_t index = argc > 4 ? static_cast<size_t>(std::atoi(argv[4])) : 0;
  unsigned width = 480, height = 270;
  if (argc > 5) std::sscanf(argv[5], "%ux%u", &width, &height);
  const double tau = argc > 6 ? std::atof(argv[6]) : 3,
               longest = argc > 7 ? std::atof(argv[7]) : 120;
  const auto readers = static_cast<uint32_t>(argc > 8 ? std::atoi(argv[8]) : 0);
  const voyager::tools::Camera camera =
      voyager::tools::read_cameras(argv[2]).at(index).resized(width, height);

  const voy::Device device = voyager::bench::streaming_device(megabytes);
  const auto start = Clock::now();
  voyager::bench::StreamedView streamed(device, argv[1], megabytes, camera.pose.position, width,
                                        height, tau, readers);
  const double opened = seconds_since(start);
  std::printf("{\"device\": \"%s\", \"opened_s\": %.2f, ", device.capabilities().deviceName,
              opened);
  watch(streamed, camera, start, longest);
  std::printf(",\n \"turned\": {");
  watch(streamed, voyager::bench::turned(camera, 3.14159265358979), Clock::now(), longest);
  std::printf("}}\n");
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "stream_quality: %s\n", error.what());
  return 1;
}
