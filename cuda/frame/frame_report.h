#pragma once
// What the host learns of a frame once it has ended: its counters and times.
#include "cuda/device/stage_timer.h"
#include "cuda/frame/instances.h"
#include "cuda/interop/external_ring.h"
#include "cuda/splat/splat_state.h"

namespace voyager::cuda {

class FrameReport {
 public:
  FrameReport(const Stream& stream, const DeviceInstances& instances)
      : timer(stream), memory_(sizeof(PassCounters) + instances.report_bytes()) {}

  // On the stream, behind the frame's work so far.
  void copy(const PassCounters* counters, const DeviceInstances& instances, cudaStream_t stream) {
    check(
        cudaMemcpyAsync(memory_.data(), counters, sizeof *counters, cudaMemcpyDeviceToHost, stream),
        "counters");
    instances.report(memory_.data() + sizeof *counters, stream);
    copied_.record(stream);
  }
  bool passed() const { return copied_.passed(); }
  void wait() const { copied_.wait(); }
  // Of a frame in flight, which may wait for the host.
  void wait_for_host() const { cuda::wait_for_host(copied_); }

  const PassCounters& counters() const {
    return *reinterpret_cast<const PassCounters*>(memory_.data());
  }
  const unsigned char* instances() const { return memory_.data() + sizeof(PassCounters); }

  StageTimer timer;
  FrameTiles tiles{};
  SplatRoom room;
  uint32_t redraws = 0;       // of the frame, since buffers had no room
  bool limited = false;       // its tiles had limits
  bool tells = false;         // what it shows of chunks
  uint64_t target_bytes = 0;  // of the images

 private:
  static_assert(sizeof(PassCounters) % alignof(std::max_align_t) == 0);
  PinnedMemory memory_;
  Event copied_{kWaitedFor};
};

}  // namespace voyager::cuda
