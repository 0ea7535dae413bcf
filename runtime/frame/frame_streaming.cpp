#include "runtime/frame/frame_streaming.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>

#include "runtime/base/error.h"
#include "runtime/frame/frame_search.h"
#include "runtime/frame/instance.h"
#include "runtime/frame/match_instances.h"

namespace voyager {
namespace {

// How far ahead chunks are asked for, in seconds: about what a disk, and a server, take.
constexpr double kHorizons[] = {0.25, 1.0};
// How far a head turns in a quarter of a second at 100 degrees a second, in radians. bench/NOTES.md
// has other angles.
constexpr double kTurn = 0.44;
// Faster than this, or longer between two frames, a viewer has jumped.
constexpr double kFastest = 150;       // metres a second
constexpr double kLongestFrame = 0.5;  // seconds
// Of a new frame's velocity in the running mean.
constexpr double kNewest = 0.25;
// Slower than this, a viewer is taken to stand still: small movements of a head do not tell where
// it will be.
constexpr double kSlowest = 0.05;  // metres a second

double length(const Vec3d& v) {
  return std::sqrt(dot(v, v));
}

Vec3f unit_float(const Vec3d& v) {
  const Vec3d n = (1 / length(v)) * v;
  return {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
}

// The tangent of an angle that is larger by `turn`, and short of a right one.
double turned(double tangent, double turn) {
  constexpr double kWidest = 1.5;
  return turn == 0 ? tangent : std::tan(std::min(std::atan(tangent) + turn, kWidest));
}

// What a camera sees, and on each side by `margin` (tangents) and `turn` (radians) more.
Wedge wedge_of(const Camera& camera, const Vec3d& origin, double margin, double turn) {
  const auto& [right, down, forward] = camera.world_to_view.row;
  const double left = -turned(camera.cx / camera.fx + margin, turn);
  const double to_right = turned((camera.width - camera.cx) / camera.fx + margin, turn);
  const double up = -turned(camera.cy / camera.fy + margin, turn);
  const double to_down = turned((camera.height - camera.cy) / camera.fy + margin, turn);
  return {
      cut_centre(camera.eye, origin),
      {unit_float(right - left * forward), unit_float(to_right * forward - right),
       unit_float(down - up * forward), unit_float(to_down * forward - down), unit_float(forward)}};
}

}  // namespace

FrameStreaming::FrameStreaming(const Scenes& scenes, Clock clock) : clock_(std::move(clock)) {
  for (const auto& scene : scenes) instances_.push_back({scene, std::make_unique<const char>()});
  for (const auto& scene : scenes)
    if (scene->streamed() &&
        std::find(streamed_.begin(), streamed_.end(), scene.get()) == streamed_.end())
      streamed_.push_back(scene.get());
  // Views that share several scenes hold them in one order.
  std::sort(streamed_.begin(), streamed_.end(), std::less<>());
  for (const Scene* scene : streamed_) bytes_read_.push_back(scene->stream->counters().bytes_read);
  if (!clock_)
    clock_ = [] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
          .count();
    };
}

FrameStreaming::~FrameStreaming() {
  for (const Instance& instance : instances_)
    if (instance.scene->streamed()) instance.scene->stream->look(instance.name.get(), {});
}

void FrameStreaming::take_over(FrameStreaming& before, std::span<const size_t> from) noexcept {
  for (size_t i = 0; i < instances_.size(); ++i)
    if (from[i] != kNewInstance) instances_[i].name.swap(before.instances_[from[i]].name);
  for (size_t i = 0; i < streamed_.size(); ++i) {
    const auto same = std::find(before.streamed_.begin(), before.streamed_.end(), streamed_[i]);
    if (same == before.streamed_.end()) continue;
    bytes_read_[i] = before.bytes_read_[static_cast<size_t>(same - before.streamed_.begin())];
  }
  clock_.swap(before.clock_);
  velocity_ = before.velocity_;
  eye_ = before.eye_;
  time_ = before.time_;
}

// Of the first eye, in the world. Instances that move are not foreseen.
std::optional<Vec3d> FrameStreaming::velocity(const FrameInput& frame) {
  const Vec3d eye = frame.eyes[0].camera.eye;
  const double time = clock_(), since = time - time_;
  if (eye_ && since > 0 && since < kLongestFrame) {
    const Vec3d now = (1 / since) * (eye - *eye_);
    if (length(now) > kFastest)
      velocity_.reset();
    else
      velocity_ = velocity_ ? (1 - kNewest) * *velocity_ + kNewest * now : now;
  } else if (since >= kLongestFrame) {
    velocity_.reset();
  }
  eye_ = eye;
  time_ = time;
  return velocity_ && length(*velocity_) > kSlowest ? velocity_ : std::nullopt;
}

Viewer FrameStreaming::viewer_of(const FrameInput& frame, size_t instance) {
  const Vec3d& origin = instances_[instance].scene->origin;
  const double footprint = instances_[instance].scene->native.footprint();
  Viewer viewer{
      cut_query(frame, instance, origin), {}, false, static_cast<float>(std::sqrt(footprint))};
  const double margin = kWedgeMargin * double{viewer.query.target_size};
  for (const FrameEye& eye : frame.eyes) {
    const Camera camera = instance_camera(frame, eye, instance);
    viewer.eyes.push_back(wedge_of(camera, origin, margin, 0));
    viewer.turned.push_back(wedge_of(camera, origin, margin, kTurn));
  }
  return viewer;
}

FrameStreaming::Holds FrameStreaming::begin(const FrameInput& frame) {
  if (streamed_.empty()) return {};
  // Before the readers know of this frame: they hold what a commit needs while they plan for it.
  if (!frame.wait_resident)
    for (const Scene* scene : streamed_) scene->stream->commit();
  const std::optional<Vec3d> way = velocity(frame);
  for (size_t i = 0; i < instances_.size(); ++i) {
    if (!instances_[i].scene->streamed()) continue;
    std::vector<Viewer> viewers = {viewer_of(frame, i)};
    for (const double horizon : kHorizons) {
      if (!way) break;
      FrameInput later = frame;
      for (FrameEye& eye : later.eyes) eye.camera.eye = eye.camera.eye + horizon * *way;
      viewers.push_back(viewer_of(later, i));
      viewers.back().ahead = true;
    }
    instances_[i].scene->stream->look(instances_[i].name.get(), std::move(viewers));
  }
  return frame.wait_resident ? hold_settled(frame.stand_in) : hold_all();
}

// Until the pools are held, others' frames and budgets may take what was waited for.
FrameStreaming::Holds FrameStreaming::hold_settled(bool stand_in) const {
  constexpr int kMostTries = 64;
  const Scene* lost = nullptr;
  for (int tries = 0; tries < kMostTries; ++tries) {
    std::vector<uint64_t> waited;
    for (const Scene* scene : streamed_) waited.push_back(scene->stream->wait(stand_in));
    Holds holds = hold_all();
    const auto same = [](const Scene* scene, uint64_t departures) {
      return scene->stream->departures() == departures;
    };
    const auto gone = std::mismatch(streamed_.begin(), streamed_.end(), waited.begin(), same).first;
    if (gone == streamed_.end()) return holds;
    lost = *gone;
  }
  throw Error(ErrorCode::over_budget,
              lost->stream->file().name() + ": found that chunks which this frame sees went " +
                  std::to_string(kMostTries) +
                  " times before it could draw them, expected a memory budget for all that other "
                  "views see, too");
}

FrameStreaming::Holds FrameStreaming::hold_all() const {
  Holds holds;
  for (const Scene* scene : streamed_) holds.push_back(scene->stream->hold());
  return holds;
}

void FrameStreaming::tell_shown(const Pipeline& pipeline) const noexcept {
  try {
    for (size_t i = 0; i < instances_.size(); ++i)
      if (const ShownChunks* shown = pipeline.shown_chunks(i))
        instances_[i].scene->stream->tell_shown(instances_[i].name.get(), *shown);
  } catch (const std::bad_alloc&) {
    return;
  }
}

void FrameStreaming::collect(FrameStats& stats) {
  for (size_t i = 0; i < streamed_.size(); ++i) {
    const StreamCounters counters = streamed_[i]->stream->counters();
    stats.bytes_streamed += counters.bytes_read - bytes_read_[i];
    stats.bytes_needed += counters.need.missing_bytes;
    bytes_read_[i] = counters.bytes_read;
  }
}

}  // namespace voyager
