#include "runtime/frame/view.h"

#include "runtime/base/clock.h"
#include "runtime/base/error.h"
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

void View::render(const FrameInput& frame, const Image& image) {
  check_camera(frame.camera, *scene_);
  const bool follows = follows_;  // the search's last run was the last frame's
  follows_ = false;
  FrameStats stats;
  Stopwatch total, stage;
  const auto lap = [&](Stage s) { stats.milliseconds[s] = stage.lap(); };
  pipeline_->search(frame), lap(kSearch);
  pipeline_->project(frame), lap(kProject);
  pipeline_->sort(frame), lap(kSort);
  pipeline_->bin(frame), lap(kBin);
  pipeline_->rasterize(frame), lap(kRasterize);
  // Whatever may fail comes before the host's image is touched.
  cut_ = pipeline_->cut();
  pipeline_->resolve(frame, image), lap(kResolve);
  stats.total_milliseconds = total.milliseconds();

  stats.frame_index = frames_++;
  stats.searched = draws_cut();
  stats.nodes_total = scene_->tree.size();
  stats.tau_star = target_size(frame.tau, frame.camera.fx);
  stats.cut_centre = cut_centre(frame.camera.eye, scene_->origin);
  pipeline_->collect(stats);
  if (!stats.changes_counted || !follows) {
    stats.entered = count_missing(cut_, last_cut_);
    stats.left = count_missing(last_cut_, cut_);
  }
  last_cut_.swap(cut_);
  stats_ = stats;
  follows_ = true;
}

}  // namespace voyager
