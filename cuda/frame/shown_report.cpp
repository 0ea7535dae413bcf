#include "cuda/frame/shown_report.h"

#include <algorithm>
#include <new>

#include "cuda/stream/device_pool.h"

namespace voyager::cuda {
namespace {

// From one frame that tells to the next: it takes about as long again to blend.
constexpr unsigned kTellEvery = 16;

}  // namespace

std::vector<ShownReport::Slots> ShownReport::slots_of(const DeviceInstances& instances) const {
  std::vector<Slots> all;
  uint32_t first = 0;
  for (const DeviceInstance& instance : instances.all()) {
    const uint32_t count =
        instance.scene->streamed() ? pool_of(*instance.scene, *device_).slots() : 0;
    all.push_back({first, count});
    first += count;
  }
  return all;
}

bool ShownReport::fits(const DeviceInstances& instances) const {
  return 2 * count(slots_of(instances)) <= planes_.size();
}

void ShownReport::fit(const DeviceInstances& instances) {
  const size_t bytes = 2 * count(slots_of(instances));
  if (bytes <= planes_.size()) return;
  planes_ = {};
  copy_.reset();
  copy_.emplace(bytes);
  planes_ = Buffer<uint8_t>(bytes);
}

bool ShownReport::wanted(const DeviceInstances& instances) {
  if (untold_ != 0) --untold_;
  const auto& all = instances.all();
  return untold_ == 0 && std::any_of(all.begin(), all.end(), [](const DeviceInstance& instance) {
           return instance.scene->streamed() && instance.scene->stream->wants_shown();
         });
}

void ShownReport::launch(const DeviceInstances& instances, const SplatView& splats,
                         const FrameInput& frame, const RasterChoices& choices,
                         cudaStream_t stream) {
  untold_ = kTellEvery;
  slots_ = slots_of(instances);
  const size_t slots = count(slots_);
  const bool base_2 = is_base_2(choices.exponential);
  ShownFrame work{};
  work.splats = splats;
  work.least_log = choices.log_threshold * (base_2 ? kLog2e : 1.0f);
  work.to_base_2 = base_2 ? 1.0f : kLog2e;
  for (size_t eye = 0; eye < frame.eyes.size(); ++eye) {
    work.width[eye] = frame.eyes[eye].camera.width;
    work.height[eye] = frame.eyes[eye].camera.height;
  }
  for (size_t i = 0; i < slots_.size(); ++i) {
    const DeviceInstance& instance = instances.all()[i];
    const CutList list = instance.draws->view().list;
    if (list.room == 0) continue;  // launch_project() gave it no number
    const bool told = slots_[i].count != 0;
    const uint32_t nodes = told ? pool_of(*instance.scene, *device_).slot_nodes() : 0;
    work.instances[work.count++] = {told ? list.nodes : nullptr, nodes, slots_[i].first};
  }
  work.drawn = planes_.data();
  work.shown = planes_.data() + slots;
  check(cudaMemsetAsync(planes_.data(), 0, 2 * slots, stream), "chunks shown");
  launch_shown(work, stream);
  check(cudaMemcpyAsync(copy_->data(), planes_.data(), 2 * slots, cudaMemcpyDeviceToHost, stream),
        "chunks shown");
}

void ShownReport::collect(bool told) noexcept {
  shown_.clear();
  if (!told) return;
  const unsigned char* const drawn = copy_->data();
  const unsigned char* const lit = drawn + count(slots_);
  try {
    for (const Slots& slots : slots_) {
      ShownChunks& shown = shown_.emplace_back(slots.count);
      for (uint32_t i = 0; i < slots.count; ++i) {
        const uint32_t slot = slots.first + i;
        shown[i] = lit[slot] != 0 ? Shown::yes : drawn[slot] != 0 ? Shown::no : Shown::unknown;
      }
    }
  } catch (const std::bad_alloc&) {
    shown_.clear();
  }
}

const ShownChunks* ShownReport::of(size_t instance) const {
  return instance < shown_.size() && !shown_[instance].empty() ? &shown_[instance] : nullptr;
}

}  // namespace voyager::cuda
