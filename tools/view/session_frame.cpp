// Frames of the session.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "runtime/base/error.h"
#include "tools/camera_writer.h"
#include "tools/console.h"
#include "tools/image_file.h"
#include "tools/output_paths.h"
#include "tools/view/camera_path.h"
#include "tools/view/session.h"

namespace voyager::view {
namespace {

constexpr size_t kTimesKept = 240;
constexpr double kFarthest = 1e17;  // metres from the origin; frames are refused some way beyond
constexpr std::chrono::milliseconds kMoving{300};  // after the last move
// Of chunks, where some could not be read: after it no other is waited for.
constexpr std::chrono::seconds kLongestBetweenArrivals{2};
constexpr uint32_t kAfterChange = 4, kAfterChangeWithBudget = 60;  // frames, until τ has settled

bool same(const VoyPose& a, const VoyPose& b) {
  return std::ranges::equal(a.position, b.position) &&
         std::ranges::equal(a.orientation, b.orientation);
}

bool same(const host::Camera& a, const host::Camera& b) {
  const VoyFrustum &f = a.frustum, &g = b.frustum;
  return same(a.pose, b.pose) && f.left == g.left && f.right == g.right && f.up == g.up &&
         f.down == g.down && a.width == b.width && a.height == b.height;
}

// Coarser than asked for, where that takes too long.
SplatSettings moving_settings(const Settings& settings) {
  SplatSettings moving = settings.left;
  if (moving.milliseconds > 0 || settings.moving_milliseconds <= 0) return moving;
  moving.milliseconds = settings.moving_milliseconds;
  moving.least_tau = settings.left.tau;
  return moving;
}

std::string cameras_of_path(const std::string& folder) {
  return folder + "/cameras.json";
}

bool is_missing(const VoyFrameStats& stats) {
  return stats.nodesUnrefined > 0 || stats.bytesNeeded > 0;
}

}  // namespace

bool Session::is_moving() const {
  return std::chrono::steady_clock::now() - moved_ < kMoving;
}

bool Session::is_still() const {
  return frames_to_draw_ == 0 && captures_.empty() && !path_ && settings == drawn_settings_ &&
         same(navigator.camera(extent_.width, extent_.height), drawn_camera_) && !is_moving();
}

void Session::resize(VkExtent2D extent) {
  extent_ = extent;
  for (const auto& view : {left_.get(), right_.get()})
    if (view) view->resize(extent);
  draw_again(kAfterChange);
}

// Once the pictures that were asked for before are taken.
void Session::put_on_path(FrameDesc& frame) {
  path_->in_frame = captures_.empty();
  if (!path_->in_frame) return;
  const tools::Camera& camera = path_->cameras[path_->next];
  frame.camera = window_camera(camera.pose, tan_half_height(camera), extent_.width, extent_.height);
  frame.wait = true;
  draw_again(1);
  save_picture(fmt::format("{}/{:04}.png", path_->folder, path_->next), false);
}

// A camera that Voyager would refuse to draw from.
void Session::return_from_nowhere() {
  const glm::dvec3& p = navigator.position();
  const bool is_near =
      std::abs(p.x) < kFarthest && std::abs(p.y) < kFarthest && std::abs(p.z) < kFarthest;
  if (!scene_ || is_near) return;
  say("found a camera 1e17 m away or farther, expected one in sight of the scene: back to the "
      "first view");
  go_home();
}

FrameDesc Session::frame() {
  return_from_nowhere();
  FrameDesc frame;
  frame.camera = navigator.camera(extent_.width, extent_.height);
  if (path_) put_on_path(frame);
  if (!same(frame.camera, drawn_camera_)) moved_ = std::chrono::steady_clock::now();
  if (is_moving() || settings != drawn_settings_)
    draw_again(settings.left.milliseconds > 0 ? kAfterChangeWithBudget : kAfterChange);
  if (left_) left_->set(is_moving() && !path_ ? moving_settings(settings) : settings.left);
  frame.left = left_.get();
  frame.right = right_.get();
  const bool shows_error = settings.right_side == RightSide::error && difference_ &&
                           error_->width == extent_.width && error_->height == extent_.height &&
                           same(error_pose_, frame.camera.pose);
  if (shows_error) frame.still = difference_->view();
  frame.split = settings.split * static_cast<float>(extent_.width);
  frame.exposure = std::exp2(settings.stops);
  frame.background = settings.background;
  frame.draw = frames_to_draw_ > 0 && left_;
  if (!captures_.empty() && captures_.front().plain) {
    frame.right = nullptr;
    frame.still = VK_NULL_HANDLE;
    frame.exposure = 1;
  }
  return frame;
}

void Session::frame_drawn(const FrameDesc& frame) {
  drawn_camera_ = frame.camera;
  drawn_settings_ = settings;
  if (path_ && path_->in_frame) {
    path_->drawn.push_back(file_camera(frame.camera));
    if (++path_->next == path_->cameras.size()) end_path();
  }
  if (frames_to_draw_ > 0) --frames_to_draw_;
  if (!frame.draw) return;
  if (!stats_) tell_time();
  if (scene_->path == loader_->request().path) opening_ = false;
  stats_ = left_->stats();
  if (frame.right) right_stats_ = right_->stats();
  if (scene_->streamed()) {
    VoyStreamingStats now = VOY_STREAMING_STATS_INIT;
    voy::check(voyGetStreamingStats(scene_->scene.get(), &now));
    if (!streaming_ || now.arrivedChunks != streaming_->arrivedChunks)
      arrival_ = std::chrono::steady_clock::now();
    streaming_ = now;
  }
  if (is_missing(*stats_)) draw_what_comes();
  frame_times_.push_back(static_cast<float>(stats_->millisecondsTotal));
  if (frame_times_.size() > kTimesKept) frame_times_.erase(frame_times_.begin());
}

// What comes must be drawn. What a budget has no room for does not come, nor does what cannot be
// read.
void Session::draw_what_comes() {
  const bool has_room = streaming_ && streaming_->seenMissingChunks > 0 &&
                        streaming_->residentChunks < streaming_->chunkSlots;
  if (!has_room) return;
  if (streaming_->failures == 0 ||
      std::chrono::steady_clock::now() - arrival_ < kLongestBetweenArrivals)
    return draw_again(2);
  if (std::exchange(told_unreadable_, true)) return;
  refuse({ErrorCode::damaged_chunk,
          fmt::format("{}: {} chunks that are seen could not be read; coarser ones are shown",
                      scene_->path, streaming_->seenMissingChunks)});
  drop_cached_bake();
}

// Of the first frame of a scene, a sample or a bake.
void Session::tell_time() const {
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - asked_;
  tools::note(fmt::format("{}: {} shown after {:.1f} s", scene_->path,
                          scene_->file.empty()           ? "a sample is"
                          : scene_->file == scene_->path ? "it is"
                                                         : "its bake is",
                          passed.count()));
}

void Session::frame_refused(const std::exception& why) {
  refused_frame_ = refusal_of(why);
  refuse(*refused_frame_);
}

void Session::save_picture(const std::string& path, bool with_panel) {
  if (!scene_ && !with_panel)
    return refuse({ErrorCode::invalid_argument,
                   path + ": found no scene, expected one to save a picture of"});
  Capture capture;
  capture.with_panel = with_panel;
  capture.then = [this, path, tells = !path_](VkExtent2D extent, std::span<const uint8_t> rgba) {
    try {
      require_no_scene(path);
      tools::write_png(path, extent.width, extent.height, rgba);
      if (tells) say(path + ": picture saved");
    } catch (const std::exception& problem) {
      path_.reset();
      refuse(problem);
    }
  };
  captures_.push_back(std::move(capture));
}

void Session::start_path(const std::string& folder, size_t pictures) {
  if (!scene_ || bookmarks.empty())
    return refuse({ErrorCode::invalid_argument,
                   folder + ": found no scene or no bookmarks, expected both for a path"});
  try {
    tools::require_distinct({cameras_of_path(folder)}, {scene_->path, scene_->file, cameras_});
  } catch (const Error& problem) {
    return refuse(problem);
  }
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  if (problem) return refuse({ErrorCode::io, folder + ": " + problem.message()});
  path_ = PathRun{path_through(bookmarks, pictures), folder};
}

// The pictures that there are, with their cameras.
void Session::end_path() {
  const PathRun run = std::move(*std::exchange(path_, std::nullopt));
  try {
    tools::write_cameras(cameras_of_path(run.folder), run.drawn);
    say(fmt::format("{}: {} pictures, and their cameras.json", run.folder, run.next));
  } catch (const std::exception& problem) {
    refuse(problem);
  }
}

void Session::cancel_path() {
  if (!path_) return;
  say(fmt::format("{}: stopped before its end", path_->folder));
  end_path();
}

}  // namespace voyager::view
