#include "cuda/frame/instances.h"

#include <algorithm>
#include <cstddef>
#include <set>

#include "runtime/base/error.h"
#include "runtime/frame/frame_search.h"
#include "runtime/frame/match_instances.h"

namespace voyager::cuda {
namespace {

// Reports lie one behind the other.
size_t aligned(size_t bytes) {
  constexpr size_t kAlign = alignof(std::max_align_t);
  return (bytes + kAlign - 1) / kAlign * kAlign;
}

}  // namespace

GaussianView DeviceInstance::view() const {
  GaussianView all = gaussians->view();
  if (parents) parents->add_to(all);
  return all;
}

DeviceInstances::DeviceInstances(MakeInstance make, const Scenes& scenes, uint32_t eyes)
    : make_(std::move(make)), eyes_(eyes) {
  set_scenes(scenes, match_instances({}, scenes));
}

void DeviceInstances::set_scenes(const Scenes& scenes, std::span<const size_t> from) {
  std::vector<DeviceInstance> next(scenes.size());
  uint64_t room = 0;
  for (size_t i = 0; i < scenes.size(); ++i) {
    const bool is_new = from[i] == kNewInstance;
    if (is_new) next[i] = make_(scenes[i]);
    room += (is_new ? next[i] : all_[from[i]]).draws->view().list.room;
  }
  if (room * eyes_ > UINT32_MAX)
    throw Error(ErrorCode::unsupported, "instances: found lists of up to " + std::to_string(room) +
                                            " Gaussians for each of " + std::to_string(eyes_) +
                                            " eyes, expected fewer than 2^32 in all");
  // From here on nothing fails.
  for (size_t i = 0; i < scenes.size(); ++i)
    if (from[i] != kNewInstance) next[i] = std::move(all_[from[i]]);
  all_.swap(next);
}

void DeviceInstances::update(const FrameInput& frame, cudaStream_t stream) {
  for (size_t i = 0; i < all_.size(); ++i)
    all_[i].draws->update(cut_query(frame, i, all_[i].scene->origin), all_[i].view(), stream);
}

bool DeviceInstances::siblings() const {
  return std::any_of(all_.begin(), all_.end(), [](const DeviceInstance& instance) {
    return instance.draws->view().blends();
  });
}

uint32_t DeviceInstances::bytes_a_gaussian() const {
  uint32_t most = 0;
  for (const DeviceInstance& instance : all_)
    most = std::max(most, instance.gaussians->bytes_a_gaussian());
  return most;
}

uint32_t DeviceInstances::bytes_a_place() const {
  uint32_t most = 0;
  for (const DeviceInstance& instance : all_) {
    const DrawView draws = instance.draws->view();
    // Which subtree owns the node, in a byte or two, and a subtree for some seven nodes.
    constexpr size_t kOwner = 2 + sizeof(SearchSubtree) / 7;
    const size_t weight = draws.weights.weighs() ? kOwner : sizeof(float);
    const size_t bytes = sizeof(float4) + (draws.list.nodes != nullptr ? sizeof(uint32_t) : 0) +
                         (draws.blends() ? weight : 0);
    most = std::max(most, static_cast<uint32_t>(bytes));
  }
  return most;
}

bool DeviceInstances::counts_changes() const {
  return std::all_of(all_.begin(), all_.end(), [](const DeviceInstance& instance) {
    return instance.draws->counts_changes();
  });
}

std::vector<Omission> DeviceInstances::omissions() const {
  std::vector<Omission> all;
  std::set<const Scene*> met;
  for (const DeviceInstance& instance : all_)
    if (!instance.parents && !instance.scene->flat() && !instance.scene->streamed() &&
        met.insert(instance.scene.get()).second)
      all.push_back({"parents, child counts, axes and opacities", "every leaf is drawn",
                     DeviceParents::bytes(*instance.scene), 0});
  return all;
}

size_t DeviceInstances::report_bytes() const {
  size_t bytes = 0;
  for (const DeviceInstance& instance : all_) bytes += aligned(instance.draws->report_bytes());
  return bytes;
}

void DeviceInstances::report(unsigned char* into, cudaStream_t stream) const {
  for (const DeviceInstance& instance : all_) {
    instance.draws->report(into, stream);
    into += aligned(instance.draws->report_bytes());
  }
}

void DeviceInstances::collect(const unsigned char* report, FrameStats& stats) const {
  for (const DeviceInstance& instance : all_) {
    instance.draws->collect(report, stats);
    report += aligned(instance.draws->report_bytes());
  }
}

}  // namespace voyager::cuda
