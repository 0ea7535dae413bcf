#pragma once
// Display periods. Without realtime a frame takes no time: each one asked for gets the next
// period. With it, the wait is real and a late frame skips periods.
#include <chrono>
#include <cstdint>

#include "api.h"

namespace test_runtime {

class Clock {
 public:
  Clock(XrDuration period, bool realtime) : period_(period), realtime_(realtime) {}

  XrDuration period() const { return period_; }
  XrTime now() const;
  // Takes the next period, or `more` periods later, and says when the frame may start.
  XrTime next(int64_t more);
  // When the current frame's image is seen.
  XrTime display_time() const { return kStart + slot_ * period_; }
  // Which period this is, from 0; what lies before is 0.
  int64_t slot(XrTime time) const;
  // How long from now, none without realtime.
  std::chrono::nanoseconds until(XrTime time) const;

 private:
  static constexpr XrTime kStart = 1000000000;

  XrDuration period_;
  bool realtime_;
  int64_t slot_ = -1;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace test_runtime
