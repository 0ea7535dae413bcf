#include "runtime/frame/view.h"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <iterator>
#include <set>

#include "runtime/base/error.h"
#include "runtime/frame/frame_search.h"
#include "runtime/frame/instance.h"
#include "runtime/frame/match_instances.h"
#include "runtime/scene/sanitise.h"

namespace voyager {
namespace {

// More would fill a device's queue of launches, where a call waits without end.
constexpr size_t kMostFramesUnderWay = 16;

[[noreturn]] void refuse_eye(size_t eye, size_t instance, int axis, double found) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", found);
  throw Error(ErrorCode::invalid_argument,
              "frame.eyes[" + std::to_string(eye) + "].pose.position: found " + text + " on axis " +
                  std::to_string(axis) + " from the scene's origin of instance " +
                  std::to_string(instance) + ", expected less than 1e18 m in magnitude");
}

// camera: in the instance's scene, whose axes are meant.
void check_camera(const Camera& camera, const Scene& scene, size_t eye, size_t instance) {
  for (int axis = 0; axis < 3; ++axis) {
    const double from_origin = camera.eye[axis] - scene.origin[axis];
    if (!(std::fabs(from_origin) < kMaxCoordinate)) refuse_eye(eye, instance, axis, from_origin);
  }
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

View::View(Scenes scenes, Backend& backend, const PipelineDesc& desc,
           std::pmr::memory_resource* memory, Workers& workers, Clock clock)
    : scenes_(std::move(scenes)),
      memory_(memory),
      streaming_(std::make_unique<FrameStreaming>(scenes_, std::move(clock))),
      desc_(desc),
      pipeline_(backend.create_pipeline(scenes_, desc, memory, workers)) {
  cuts_.reserve(scenes_.size());
  for (size_t i = 0; i < scenes_.size(); ++i) cuts_.emplace_back(memory);
}

void View::set_scenes(Scenes scenes) {
  while (finish_one(true)) continue;
  const std::vector<size_t> from = match_instances(scenes_, scenes);
  auto streaming = std::make_unique<FrameStreaming>(scenes);
  std::vector<InstanceCut> cuts;
  cuts.reserve(scenes.size());
  pipeline_->set_scenes(scenes, from);
  // From here on nothing fails.
  for (const size_t of : from)
    cuts.push_back(of == kNewInstance ? InstanceCut(memory_) : std::move(cuts_[of]));
  cuts_.swap(cuts);
  streaming->take_over(*streaming_, from);
  streaming_.swap(streaming);
  scenes_.swap(scenes);
  drawn_ = false;
}

bool View::draws_any_cut() const {
  for (size_t i = 0; i < scenes_.size(); ++i)
    if (draws_cut(i)) return true;
  return false;
}

// A search that does not count what entered and left has its cuts compared. A cut that
// is far is only read for that; where the one before it was not, the frame before failed,
// and the comparison is with the last that was.
bool View::read_changes(bool follows, FrameStats& stats) {
  const bool counted = stats.changes_counted && follows;
  if (counted && !pipeline_->cut_is_near()) return false;
  if (!counted) stats.entered = stats.left = 0;
  for (size_t i = 0; i < cuts_.size(); ++i) {
    InstanceCut& of = cuts_[i];
    pipeline_->read_cut(i, of.cut);
    if (counted) continue;
    stats.entered += count_missing(of.cut, of.last);
    stats.left += count_missing(of.last, of.cut);
  }
  return true;
}

void View::keep_cuts(bool read) {
  drawn_ = true;
  for (InstanceCut& of : cuts_) {
    if (read) of.last.swap(of.cut);
    of.read = read;
  }
}

FrameStats View::known_stats(const FrameInput& frame) {
  FrameStats stats;
  streaming_->collect(stats);
  for (const auto& scene : scenes_) stats.nodes_total += scene->node_count;
  stats.tau = frame.tau;
  if (budget_) {
    stats.time_budget = budget_->desc().milliseconds;
    stats.tau_is_greatest = frame.tau >= budget_->desc().greatest_tau;
  }
  if (scenes_.empty()) return stats;
  const CutQuery query = cut_query(frame, 0, scenes_[0]->origin);
  stats.tau_star = query.target_size;
  stats.cut_centre = query.centre;
  return stats;
}

void View::set_time_budget(const TimeBudgetDesc& desc, double tau) {
  if (budget_)
    budget_->set(desc);
  else
    budget_.emplace(desc, tau);
}

// Frames that have ended meanwhile are heard first.
double View::next_tau(double chosen) {
  while (finish_one(false)) continue;
  return budget_ ? budget_->next_tau() : chosen;
}

// Of a frame that has ended, in the frames' order. That one was incomplete is not forgotten before
// somebody has heard of it.
void View::keep_stats(const FrameStats& stats) {
  const uint64_t unheard = heard_ ? 0 : stats_.pairs_dropped;
  stats_ = stats;
  stats_.pairs_dropped += unheard;
  ended_ = true;
  heard_ = false;
  if (budget_ && draws_any_cut()) budget_->measure(stats.tau, stats.total_milliseconds);
}

void View::draw(const FrameInput& frame, bool follows) {
  while (finish_one(true)) continue;
  FrameStats stats = known_stats(frame);
  pipeline_->draw(frame, stats);
  streaming_->tell_shown(*pipeline_);
  const bool read = read_changes(follows, stats);
  pipeline_->resolve(frame, stats);
  stats.frame_index = frames_++;
  keep_cuts(read);
  keep_stats(stats);
}

// A frame whose changes are not counted has its cut read, once its search has ended.
void View::submit(const FrameInput& frame, bool follows) {
  while (finish_one(false)) continue;
  if (under_way_.size() >= kMostFramesUnderWay) finish_one(true);
  const bool counted = follows && pipeline_->counts_changes();
  under_way_.push_back({known_stats(frame), !counted});
  UnderWay& now = under_way_.back();
  try {
    pipeline_->submit(frame, !drawn_ || !counted);
  } catch (...) {
    under_way_.pop_back();
    throw;
  }
  now.stats.frame_index = frames_++;
  keep_cuts(!counted && try_read_changes(now.stats));
}

// The frame is on its way, so what cannot be read fails no call.
bool View::try_read_changes(FrameStats& stats) {
  try {
    return read_changes(false, stats);
  } catch (const std::exception&) {
    stats.entered = stats.left = 0;
    return false;
  }
}

bool View::finish_one(bool wait) {
  if (under_way_.empty()) return false;
  UnderWay& oldest = under_way_.front();
  const uint64_t entered = oldest.stats.entered, left = oldest.stats.left;
  if (!pipeline_->finish(wait, oldest.stats)) return false;
  streaming_->tell_shown(*pipeline_);
  if (oldest.changes_known) oldest.stats.entered = entered, oldest.stats.left = left;
  keep_stats(oldest.stats);
  under_way_.pop_front();
  return true;
}

void View::render(const FrameInput& frame) {
  assert(frame.instances.empty() || frame.instances.size() == scenes_.size());
  assert(frame.looks.empty() || frame.looks.size() == scenes_.size());
  assert(frame.eyes.size() == desc_.eyes);
  for (size_t eye = 0; eye < frame.eyes.size(); ++eye)
    for (size_t i = 0; i < scenes_.size(); ++i)
      check_camera(instance_camera(frame, frame.eyes[eye], i), *scenes_[i], eye, i);
  const auto holds = streaming_->begin(frame);
  const bool follows = follows_;  // the search's last run was the last frame's
  follows_ = false;
  if (frame.eyes[0].image.external.ring != nullptr)
    submit(frame, follows);
  else
    draw(frame, follows);
  follows_ = true;
}

const FrameStats& View::stats() {
  while (finish_one(false)) continue;
  if (!ended_) finish_one(true);
  heard_ = true;
  return stats_;
}

// A splat may be of any scene, so what each would cost is known where there is one scene.
std::vector<Omission> View::omissions() const {
  std::vector<Omission> all;
  const auto add = [&](std::vector<Omission> more) {
    std::move(more.begin(), more.end(), std::back_inserter(all));
  };
  std::set<const Scene*> met;
  const bool one = std::all_of(scenes_.begin(), scenes_.end(),
                               [&](const auto& scene) { return scene == scenes_[0]; });
  for (size_t i = 0; i < scenes_.size(); ++i)
    if (met.insert(scenes_[i].get()).second)
      add(omissions_of(*scenes_[i], draws_cut(i), one ? stats_.splats / desc_.eyes : 0));
  add(pipeline_->omissions());
  return all;
}

const std::pmr::vector<uint32_t>& View::cut(size_t instance) {
  InstanceCut& of = cuts_[instance];
  if (of.read) return of.last;
  if (!follows_)
    throw Error(
        ErrorCode::unsupported,
        "cut: found a device whose last frame failed, expected a frame that succeeded since");
  while (finish_one(true)) continue;
  pipeline_->read_cut(instance, of.last);
  of.read = true;
  return of.last;
}

}  // namespace voyager
