#include "runtime/frame/host_instances.h"

#include "runtime/base/error.h"
#include "runtime/frame/frame_search.h"
#include "runtime/frame/instance.h"

namespace voyager {

HostInstances::HostInstances(const Scenes& scenes, const PipelineDesc& desc, size_t grain,
                             std::pmr::memory_resource* memory, Workers& workers)
    : grain_(grain) {
  for (const auto& scene : scenes) all_.emplace_back(scene, desc, memory, workers);
}

void HostInstances::update(const FrameInput& frame, Workers& workers) {
  places_ = 0;
  for (size_t i = 0; i < all_.size(); ++i) {
    HostInstance& instance = all_[i];
    for (size_t eye = 0; eye < frame.eyes.size(); ++eye)
      instance.cameras[eye] = instance_camera(frame, frame.eyes[eye], i);
    instance.draws.update(cut_query(frame, i, instance.scene->origin), workers);
    instance.first = (places_ + grain_ - 1) / grain_ * grain_;
    places_ = instance.first + instance.draws.items().size();
  }
  // A place is 32 bits of the sort's keys.
  if (places_ > uint64_t{1} << 32)
    throw Error(ErrorCode::unsupported, "instances: found " + std::to_string(places_) +
                                            " Gaussians to draw, expected at most 2^32");
}

void HostInstances::collect(FrameStats& stats) const {
  for (const HostInstance& instance : all_) instance.draws.collect(stats);
}

}  // namespace voyager
