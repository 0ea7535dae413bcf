#include "runtime/frame/view.h"

#include "runtime/base/error.h"
#include "runtime/frame/frame_search.h"
#include "runtime/scene/sanitise.h"

namespace voyager {
namespace {

void check_camera(const Camera& camera, const Scene& scene) {
  for (int i = 0; i < 3; ++i)
    if (!(std::fabs(camera.eye[i] - scene.origin[i]) < kMaxCoordinate))
      throw Error(ErrorCode::invalid_argument, "eye position: found " +
                                                   std::to_string(camera.eye[i]) +
                                                   ", expected a finite coordinate below 1e18 m");
}

// Both ascending.
uint64_t count_missing(const std::pmr::vector<uint32_t>& from,
                       const std::pmr::vector<uint32_t>& in) {
  uint64_t missing = 0;
  auto other = in.begin();
  for (const uint32_t node : from) {
    while (other != in.end() && *other < node) ++other;
    missing += other == in.end() || *other != node;
  }
  return missing;
}

}  // namespace

View::View(std::shared_ptr<const Scene> scene, Backend& backend, const PipelineDesc& desc,
           std::pmr::memory_resource* memory, Workers& workers)
    : scene_(std::move(scene)),
      desc_(desc),
      pipeline_(backend.create_pipeline(scene_, desc, memory, workers)),
      cut_(memory),
      last_cut_(memory) {}

// A search that does not count what entered and left has its cuts compared. A cut that
// is far is only read for that; where the one before it was not, the frame before failed,
// and the comparison is with the last that was.
bool View::read_changes(bool follows, FrameStats& stats) {
  const bool counted = stats.changes_counted && follows;
  if (counted && !pipeline_->cut_is_near()) return false;
  pipeline_->read_cut(cut_);
  if (!counted) {
    stats.entered = count_missing(cut_, last_cut_);
    stats.left = count_missing(last_cut_, cut_);
  }
  return true;
}

void View::render(const FrameInput& frame, const Image& image) {
  check_camera(frame.camera, *scene_);
  const bool follows = follows_;  // the search's last run was the last frame's
  follows_ = false;
  FrameStats stats;
  stats.searched = draws_cut();
  stats.nodes_total = scene_->tree.size();
  const CutQuery query = cut_query(frame, scene_->origin);
  stats.tau_star = query.target_size;
  stats.cut_centre = query.centre;
  pipeline_->draw(frame, image, stats);
  const bool read = read_changes(follows, stats);
  pipeline_->resolve(frame, image, stats);
  stats.frame_index = frames_++;
  if (read) last_cut_.swap(cut_);
  cut_read_ = read;
  stats_ = stats;
  follows_ = true;
}

const std::pmr::vector<uint32_t>& View::cut() {
  if (cut_read_) return last_cut_;
  if (!follows_)
    throw Error(ErrorCode::unsupported,
                "cut: found one on a device after a frame that failed, expected a frame that was "
                "drawn since");
  pipeline_->read_cut(last_cut_);
  cut_read_ = true;
  return last_cut_;
}

}  // namespace voyager
