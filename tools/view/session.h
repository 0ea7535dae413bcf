#pragma once
// What the window shows and what is asked of it, whoever asks: the panel, the keys, a script.
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/view/detail_map.h"
#include "tools/view/frame_renderer.h"
#include "tools/view/navigator.h"
#include "tools/view/refusal.h"
#include "tools/view/scene_loader.h"
#include "tools/view/still_image.h"
#include "tools/view/truth.h"
#include "tools/view/view_options.h"

namespace voyager::view {

// What is right of the line.
enum class RightSide { none, settings, detail, error };

struct Settings {
  SplatSettings left, right{.tau = 12};
  float moving_milliseconds = 60;  // what is drawn coarser for while the camera moves; 0: nothing
  RightSide right_side = RightSide::none;
  float split = 0.5f;  // where the line is, of the width
  float stops = 0;     // of exposure: each doubles the light
  float background[3] = {0, 0, 0};
  bool show_panel = true;
  bool operator==(const Settings&) const = default;
};

// A picture of the next frame.
struct Capture {
  bool with_panel = false;
  bool plain = false;  // the left view alone, as Voyager drew it
  std::function<void(VkExtent2D, std::span<const uint8_t> rgba)> then;
};

struct Message {
  std::string text;
  std::chrono::steady_clock::time_point since;
};

// Pictures along a path, one a frame.
struct PathRun {
  std::vector<tools::Camera> cameras;
  std::string folder;
  std::vector<tools::Camera> drawn{};  // as they were, in the window's size
  size_t next = 0;
  bool in_frame = false;  // whether this frame is the next picture
};

class Session {
 public:
  // All must outlive it.
  Session(const host::Device& vulkan, const voy::Device& device, const ViewOptions& options);

  // Scenes. A path that cannot be opened is said, and what was shown stays.
  void open(const std::string& path);
  const LoadedScene* scene() const { return scene_ ? &*scene_ : nullptr; }
  LoadProgress loading() const;
  // Until something of what was opened last was drawn, or it was refused.
  bool is_opening() const { return opening_; }
  void set_budget(double megabytes);
  double budget() const { return budget_; }

  // Cameras.
  Navigator navigator;
  std::vector<tools::Camera> bookmarks;
  void go_to(const tools::Camera& camera);
  void go_home();
  void add_bookmark();
  void save_bookmarks(const std::string& path);

  // Pictures. The folder is made.
  void save_picture(const std::string& path, bool with_panel);
  void start_path(const std::string& folder, size_t pictures);
  void cancel_path();
  const std::optional<PathRun>& path() const { return path_; }
  std::deque<Capture>& captures() { return captures_; }

  // The error of the view as it is now.
  void measure_error();
  bool is_measuring() const { return waits_for_picture_ || truth_ != nullptr; }
  const std::optional<TruthResult>& error() const { return error_; }

  // What people are told, for a while; the last comes last.
  void say(const std::string& text);
  // What was asked for and not done. People are told, but for what ends the program: that is its
  // last line.
  void refuse(const Refusal& refusal);
  void refuse(const std::exception& problem) { refuse(refusal_of(problem)); }
  const std::vector<Refusal>& refusals() const { return refusals_; }
  // Something was refused that ends the program.
  bool is_over() const { return ends_when_refused_ && !refusals_.empty(); }
  const std::deque<Message>& messages() const { return messages_; }

  Settings settings;

  // Once a frame, before it: what came from other threads, and what changed. The queue is made idle
  // where something goes.
  void update(VkExtent2D extent);
  void resize(VkExtent2D extent);
  // What to draw; overlay, record and semaphores are the window's.
  FrameDesc frame();
  // After it.
  void frame_drawn(const FrameDesc& frame);
  // After Voyager refused a frame: the scene is closed before the next.
  void frame_refused(const std::exception& why);
  // Nothing has changed for a while and nothing is loading, so that the next frame is the last one.
  bool is_still() const;
  // Whether the truth or the level of detail is being made.
  bool is_busy() const {
    return is_measuring() || detail_job_ != nullptr ||
           (settings.right_side == RightSide::detail && detail_is_possible() && !detail_scene_);
  }

  // Of the last frame that Voyager drew, left of the line and right of it.
  const std::optional<VoyFrameStats>& stats() const { return stats_; }
  const std::optional<VoyFrameStats>& right_stats() const { return right_stats_; }
  const std::optional<VoyStreamingStats>& streaming() const { return streaming_; }
  const std::vector<float>& frame_times() const { return frame_times_; }  // ms, the last is newest

 private:
  void adopt(LoadedScene scene);
  void close_scene();
  void take_loaded();
  void drop_cached_bake();
  void draw_what_comes();
  void require_no_scene(const std::string& output) const;
  void put_on_path(FrameDesc& frame);
  void end_path();
  void return_from_nowhere();
  void tell_time() const;
  void update_right_side();
  void update_detail();
  void update_error();
  void draw_again(uint32_t frames) { frames_to_draw_ = std::max(frames_to_draw_, frames); }
  void show_right(std::unique_ptr<SplatView> view);
  uint64_t budget_bytes() const { return static_cast<uint64_t>(budget_ * 1e6); }
  bool detail_is_possible() const;
  bool is_moving() const;

  const host::Device& vulkan_;
  const voy::Device& device_;
  const VoyBackend backend_;
  const std::string keep_;
  const std::string cameras_;
  const bool ends_when_refused_;
  double budget_;
  VkExtent2D extent_ = {0, 0};
  std::optional<Refusal> refused_frame_;
  bool opening_ = false;
  std::chrono::steady_clock::time_point asked_ = {};  // for the scene
  std::optional<tools::Camera> home_;                 // of cameras_, or of the scene

  std::unique_ptr<SceneLoader> loader_;
  // Views go before the scenes that they draw.
  std::optional<LoadedScene> scene_, detail_scene_;
  std::unique_ptr<SplatView> left_, right_;
  std::unique_ptr<DetailJob> detail_job_;
  std::vector<uint32_t> detail_nodes_;  // of the last job
  bool waits_for_picture_ = false;
  std::unique_ptr<TruthJob> truth_, dropped_truth_;  // the latter of a scene that is closed
  std::optional<TruthResult> error_;
  std::unique_ptr<StillImage> difference_;
  VoyPose error_pose_ = {};  // of the camera that the difference is of

  std::optional<PathRun> path_;
  std::deque<Capture> captures_;
  std::deque<Message> messages_;
  std::vector<Refusal> refusals_;

  uint32_t frames_to_draw_ = 0;
  std::chrono::steady_clock::time_point moved_ = {};  // the camera, last
  Settings drawn_settings_;
  host::Camera drawn_camera_ = {};
  std::optional<VoyFrameStats> stats_, right_stats_;
  std::optional<VoyStreamingStats> streaming_;
  std::chrono::steady_clock::time_point arrival_ = {};  // of a chunk, last
  bool told_unreadable_ = false;                        // of this scene
  std::vector<float> frame_times_;
};

}  // namespace voyager::view
