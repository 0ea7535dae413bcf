// What is right of the line: other settings, the level of detail, the error.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "tools/view/camera_path.h"
#include "tools/view/session.h"

namespace voyager::view {

bool Session::detail_is_possible() const {
  return scene_ && scene_->has_tree() && left_ && left_->has_drawn();
}

void Session::show_right(std::unique_ptr<SplatView> view) {
  vulkan_.wait_idle();
  right_ = nullptr;  // before its scene
  right_ = std::move(view);
  if (right_) {
    right_->set(settings.right_side == RightSide::detail ? SplatSettings{} : settings.right);
    right_->resize(extent_);
  }
  right_stats_.reset();
  draw_again(2);
}

void Session::update_right_side() {
  update_detail();
  update_error();
  const bool wants_view = settings.right_side == RightSide::settings && scene_;
  if (wants_view && (!right_ || detail_scene_)) {
    show_right(std::make_unique<SplatView>(vulkan_, device_, scene_->scene, scene_->has_tree()));
    detail_scene_.reset();
    detail_nodes_.clear();
  }
  const bool wants_detail = settings.right_side == RightSide::detail;
  if (right_ && !wants_view && !wants_detail) {
    show_right(nullptr);
    detail_scene_.reset();
    detail_nodes_.clear();
  }
  if (right_ && wants_view) right_->set(settings.right);
}

// Again whenever the cut has changed.
void Session::update_detail() {
  if (settings.right_side != RightSide::detail || !detail_is_possible()) return;
  if (!detail_job_) {
    std::vector<uint32_t> nodes = left_->cut();
    if (nodes == detail_nodes_) return;
    detail_nodes_ = nodes;
    const VoySceneInfo& info = scene_->info;
    detail_job_ =
        std::make_unique<DetailJob>(device_, scene_->file, std::move(nodes),
                                    info.pixelFilter * info.nativePixel * info.nativePixel);
  }
  if (!detail_job_->done()) return;
  auto scene = detail_job_->take();
  if (!scene) refuse(detail_job_->error());
  detail_job_ = nullptr;
  if (!scene) {
    settings.right_side = RightSide::none;
    return;
  }
  vulkan_.wait_idle();
  right_ = nullptr;
  detail_scene_ = std::move(scene);
  show_right(std::make_unique<SplatView>(vulkan_, device_, detail_scene_->scene, false));
}

void Session::measure_error() {
  if (!scene_ || is_measuring()) return;
  if (scene_->file.empty())
    return refuse({ErrorCode::invalid_argument,
                   scene_->path + ": found no bake yet, expected it for the error"});
  waits_for_picture_ = true;
  Capture capture;
  capture.plain = true;
  capture.then = [this](VkExtent2D, std::span<const uint8_t> rgba) {
    waits_for_picture_ = false;
    TruthRequest request{scene_->file, file_camera(drawn_camera_), {rgba.begin(), rgba.end()}};
    request.backend = backend_;
    std::copy_n(settings.background, 3, request.background);
    error_pose_ = drawn_camera_.pose;
    truth_ = std::make_unique<TruthJob>(std::move(request));
  };
  captures_.push_back(std::move(capture));
}

void Session::update_error() {
  if (dropped_truth_ && dropped_truth_->done()) dropped_truth_ = nullptr;
  if (!truth_ || !truth_->done()) return;
  error_ = truth_->result();
  if (!error_) refuse(truth_->error());
  truth_ = nullptr;
  if (!error_) return;
  vulkan_.wait_idle();
  const VkExtent2D size = {error_->width, error_->height};
  difference_ = std::make_unique<StillImage>(vulkan_, size, error_->difference);
  settings.right_side = RightSide::error;
  say(std::isinf(error_->psnr)
          ? "this view is the truth"
          : fmt::format("this view has {:.2f} dB against the truth", error_->psnr));
  draw_again(2);
}

}  // namespace voyager::view
