// Scenes and cameras of the session.
#include "tools/view/session.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "runtime/base/error.h"
#include "tools/camera_writer.h"
#include "tools/console.h"
#include "tools/output_paths.h"
#include "tools/view/camera_path.h"

namespace voyager::view {
namespace {

constexpr size_t kMostMessages = 6;
constexpr std::chrono::seconds kMessageTime{12};

double distance_between(const double* a, const double* b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// To the middle of the scene, within its own size.
double orbit_distance(const VoySceneInfo& info, const tools::Camera& camera) {
  double middle[3];
  for (int i = 0; i < 3; ++i) middle[i] = (info.boundsMin[i] + info.boundsMax[i]) / 2;
  return std::clamp(distance_between(middle, camera.pose.position), 0.1,
                    distance_between(info.boundsMin, info.boundsMax));
}

}  // namespace

Session::Session(const host::Device& vulkan, const voy::Device& device, const ViewOptions& options)
    : vulkan_(vulkan),
      device_(device),
      backend_(options.backend),
      keep_(options.keep),
      cameras_(options.cameras),
      ends_when_refused_(options.frames > 0 || !options.screenshot.empty()),
      budget_(options.budget) {
  settings.left.tau = static_cast<float>(options.tau);
  settings.left.milliseconds = static_cast<float>(options.milliseconds);
  settings.left.antialias = options.antialias;
  settings.right.antialias = options.antialias;
  if (!options.cameras.empty()) {
    bookmarks = tools::read_cameras(options.cameras);
    home_ = tools::camera_at(options.camera, 1, bookmarks, options.cameras).front();
  }
}

void Session::open(const std::string& path) {
  asked_ = std::chrono::steady_clock::now();
  opening_ = true;
  if (!keep_.empty()) {
    try {
      tools::require_distinct({keep_}, {path});
      tools::require_writable(keep_);
    } catch (const Error& problem) {
      opening_ = false;
      return refuse(problem);
    }
  }
  loader_ = nullptr;  // ends what is in progress
  loader_ = std::make_unique<SceneLoader>(device_, LoadRequest{path, budget_bytes(), keep_});
}

LoadProgress Session::loading() const {
  return loader_ ? loader_->progress() : LoadProgress{};
}

void Session::set_budget(double megabytes) {
  budget_ = megabytes;
  if (!scene_ || !scene_->streamed()) return;
  try {
    voy::check(voySetSceneMemoryBudget(scene_->scene.get(), budget_bytes()));
  } catch (const voy::Error& problem) {
    refuse(problem);
  }
  draw_again(8);
}

void Session::go_to(const tools::Camera& camera) {
  navigator.look_from(camera, scene_ ? orbit_distance(scene_->info, camera) : navigator.distance());
}

void Session::go_home() {
  if (home_) go_to(*home_);
}

void Session::add_bookmark() {
  bookmarks.push_back(file_camera(navigator.camera(extent_.width, extent_.height)));
  say(fmt::format("bookmark {} added", bookmarks.size() - 1));
}

void Session::save_bookmarks(const std::string& path) {
  try {
    require_no_scene(path);
    tools::write_cameras(path, bookmarks);
    say(fmt::format("{}: {} cameras saved", path, bookmarks.size()));
  } catch (const std::exception& problem) {
    refuse(problem);
  }
}

// Nothing that is shown is written over.
void Session::require_no_scene(const std::string& output) const {
  if (scene_) tools::require_distinct({output}, {scene_->path, scene_->file});
}

void Session::say(const std::string& text) {
  tools::note(text);
  messages_.push_back({text, std::chrono::steady_clock::now()});
  if (messages_.size() > kMostMessages) messages_.pop_front();
}

void Session::refuse(const Refusal& refusal) {
  refusals_.push_back(refusal);
  if (!ends_when_refused_) say(refusal.text);
}

// Views go before the scenes that they draw, and both once the queue is done with them.
void Session::close_scene() {
  vulkan_.wait_idle();
  cancel_path();
  left_ = nullptr;
  right_ = nullptr;
  detail_job_ = nullptr;
  detail_nodes_.clear();
  detail_scene_.reset();
  scene_.reset();
  waits_for_picture_ = false;
  if (truth_) truth_->stop();
  if (truth_) dropped_truth_ = std::move(truth_);
  error_.reset();
  difference_ = nullptr;
  stats_.reset();
  right_stats_.reset();
  streaming_.reset();
  told_unreadable_ = false;
}

void Session::adopt(LoadedScene scene) {
  close_scene();
  scene_ = std::move(scene);
  left_ = std::make_unique<SplatView>(vulkan_, device_, scene_->scene, scene_->has_tree());
  left_->set(settings.left);
  left_->resize(extent_);
  if (scene_->streamed() && loader_->request().budget != budget_bytes()) set_budget(budget_);
  if (scene_->first) {
    if (cameras_.empty()) home_ = scene_->camera;
    navigator.set_speed(0.05 * distance_between(scene_->info.boundsMin, scene_->info.boundsMax));
    go_home();
  }
  draw_again(8);
}

void Session::update(VkExtent2D extent) {
  extent_ = extent;
  if (const auto refusal = std::exchange(refused_frame_, std::nullopt)) {
    opening_ = false;
    if (refusal->code == ErrorCode::damaged_chunk) drop_cached_bake();
    close_scene();
  }
  while (!messages_.empty() &&
         std::chrono::steady_clock::now() - messages_.front().since > kMessageTime)
    messages_.pop_front();
  if (loader_) take_loaded();
  update_right_side();
}

void Session::take_loaded() {
  if (auto note = loader_->take_note()) say(*note);
  if (auto error = loader_->take_error()) {
    refuse(*error);
    opening_ = false;
  }
  auto scene = loader_->take();
  if (!scene) return;
  try {
    adopt(std::move(*scene));
  } catch (const voy::Error& problem) {
    refuse(problem);
    opening_ = false;
    close_scene();
  }
}

// So that it is made anew the next time.
void Session::drop_cached_bake() {
  const bool is_cached = keep_.empty() && !scene_->file.empty() && scene_->file != scene_->path;
  std::error_code ignored;
  if (is_cached && std::filesystem::remove(scene_->file, ignored))
    say(scene_->path + ": its bake was damaged and is removed; opened again, it is baked anew");
}

}  // namespace voyager::view
