#include "runtime/frame/host_instances.h"

#include "runtime/base/error.h"
#include "runtime/frame/frame_search.h"
#include "runtime/frame/instance.h"
#include "runtime/frame/match_instances.h"

namespace voyager {

HostInstances::HostInstances(const Scenes& scenes, const PipelineDesc& desc, size_t grain,
                             std::pmr::memory_resource* memory, Workers& workers)
    : desc_(desc), memory_(memory), workers_(workers), grain_(grain) {
  set_scenes(scenes, match_instances({}, scenes));
}

void HostInstances::set_scenes(const Scenes& scenes, std::span<const size_t> from) {
  std::vector<std::unique_ptr<HostInstance>> next(scenes.size());
  for (size_t i = 0; i < scenes.size(); ++i)
    if (from[i] == kNewInstance)
      next[i] = std::make_unique<HostInstance>(scenes[i], desc_, memory_, workers_);
  // From here on nothing fails.
  for (size_t i = 0; i < scenes.size(); ++i)
    if (from[i] != kNewInstance) next[i] = std::move(all_[from[i]]);
  all_.swap(next);
}

void HostInstances::update(const FrameInput& frame) {
  places_ = 0;
  for (size_t i = 0; i < all_.size(); ++i) {
    HostInstance& instance = *all_[i];
    for (size_t eye = 0; eye < frame.eyes.size(); ++eye)
      instance.cameras[eye] = instance_camera(frame, frame.eyes[eye], i);
    instance.look = instance_look(frame, i);
    instance.draws.update(cut_query(frame, i, instance.scene->origin), workers_);
    instance.first = (places_ + grain_ - 1) / grain_ * grain_;
    places_ = instance.first + instance.draws.items().size();
  }
  // A place is 32 bits of the sort's keys.
  if (places_ > uint64_t{1} << 32)
    throw Error(ErrorCode::unsupported, "instances: found " + std::to_string(places_) +
                                            " Gaussians to draw, expected at most 2^32");
}

void HostInstances::collect(FrameStats& stats) const {
  for (const auto& instance : all_) instance->draws.collect(stats);
}

}  // namespace voyager
