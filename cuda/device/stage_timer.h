#pragma once
// When each stage of a frame ends on the device.
#include "cuda/device/frame_timer.h"
#include "runtime/frame/backend.h"

namespace voyager::cuda {

class StageTimer {
 public:
  explicit StageTimer(const Stream& stream) : timer_(stream, kMarks) {}

  void begin();
  // The stages that have ended, in their order; each at most once.
  void end(Stage stage);
  // What ended after `stage` is done again, and its time is that of both.
  void go_back_to(Stage stage);
  // What the stream did since the last stage ended is no part of the next: it waited for the host.
  // Once in a frame.
  void leave_out();
  // Waits. Sets the times of what has ended, and their sum.
  void collect(FrameStats& stats) const;

 private:
  static constexpr size_t kLeftOut = kStageCount + 1, kMarks = kStageCount + 2;

  FrameTimer timer_;
  Stage ended_[kStageCount] = {};
  size_t count_ = 0;
  size_t left_out_before_ = kStageCount;  // of ended_; kStageCount: nothing was left out
};

}  // namespace voyager::cuda
