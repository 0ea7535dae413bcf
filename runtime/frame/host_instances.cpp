#include "runtime/frame/host_instances.h"

#include "runtime/base/error.h"
#include "runtime/frame/instance.h"

namespace voyager {

HostInstances::HostInstances(const Scenes& scenes, const PipelineDesc& desc, size_t grain,
                             std::pmr::memory_resource* memory)
    : grain_(grain) {
  for (const auto& scene : scenes) all_.emplace_back(scene, desc, memory);
}

void HostInstances::update(const FrameInput& frame, Workers& workers) {
  places_ = 0;
  for (size_t i = 0; i < all_.size(); ++i) {
    HostInstance& instance = all_[i];
    instance.camera = instance_camera(frame, i);
    instance.draws.update(instance.camera, frame.tau, workers);
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
