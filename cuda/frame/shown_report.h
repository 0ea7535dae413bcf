#pragma once
// What frames tell streams of the chunks that they have shown: found on the device, copied behind
// the frame's counters. One frame at a time tells.
#include <optional>
#include <vector>

#include "cuda/device/buffer.h"
#include "cuda/device/device.h"
#include "cuda/device/stream.h"
#include "cuda/frame/instances.h"
#include "cuda/splat/shown.h"
#include "cuda/splat/splat_launch.h"

namespace voyager::cuda {

class ShownReport {
 public:
  explicit ShownReport(std::shared_ptr<const Device> device) : device_(std::move(device)) {}

  // Whether there is room for the pools' slots.
  bool fits(const DeviceInstances& instances) const;
  // Makes it. Nothing on the device uses it. Throws Error.
  void fit(const DeviceInstances& instances);

  // Whether the next frame is to tell: a stream wants to know, and the frames before it that have
  // told are some time ago.
  bool wanted(const DeviceInstances& instances);
  // Behind the image of such a frame, which has one pass.
  void launch(const DeviceInstances& instances, const SplatView& splats, const FrameInput& frame,
              const RasterChoices& choices, cudaStream_t stream);
  // Once a frame has ended. told: it was such a frame. What there is no memory for is not told.
  void collect(bool told) noexcept;
  // An instance's, if the last frame that has ended has told of it.
  const ShownChunks* of(size_t instance) const;

 private:
  // Of an instance in the planes below; none of one that is not streamed.
  struct Slots {
    uint32_t first, count;
  };

  std::vector<Slots> slots_of(const DeviceInstances& instances) const;
  static size_t count(const std::vector<Slots>& slots) {
    return slots.empty() ? 0 : slots.back().first + slots.back().count;
  }

  std::shared_ptr<const Device> device_;
  Buffer<uint8_t> planes_;  // two, as ShownFrame has them; 1 or 0
  std::optional<PinnedMemory> copy_;
  std::vector<Slots> slots_;  // of the frame that tells
  std::vector<ShownChunks> shown_;
  unsigned untold_ = 0;  // frames that are not to tell, from the next on
};

}  // namespace voyager::cuda
