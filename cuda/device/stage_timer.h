#pragma once
// When each stage of a frame ends on the device.
#include "cuda/device/frame_timer.h"
#include "runtime/frame/backend.h"

namespace voyager::cuda {

class StageTimer {
 public:
  explicit StageTimer(const Stream& stream) : timer_(stream, kStageCount + 1) {}

  void begin();
  // The stages that have ended, in their order; each at most once.
  void end(Stage stage);
  // What ended after `stage` is done again, and its time is that of both.
  void go_back_to(Stage stage);
  // Waits. Sets the times of what has ended, and their sum.
  void collect(FrameStats& stats) const;

 private:
  FrameTimer timer_;
  Stage ended_[kStageCount] = {};
  size_t count_ = 0;
};

}  // namespace voyager::cuda
