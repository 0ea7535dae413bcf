#include "clock.h"

#include <algorithm>

namespace test_runtime {

XrTime Clock::now() const {
  if (!realtime_) return kStart + std::max<int64_t>(slot_, 0) * period_ - period_ / 2;
  const auto passed = std::chrono::steady_clock::now() - start_;
  return kStart - period_ / 2 + std::chrono::nanoseconds(passed).count();
}

XrTime Clock::next(int64_t more) {
  slot_ += 1 + more;
  if (realtime_) slot_ = std::max(slot_, slot(now()) + 1);
  return display_time() - period_;
}

int64_t Clock::slot(XrTime time) const {
  return std::max<int64_t>((time - kStart + period_ / 2) / period_, 0);
}

std::chrono::nanoseconds Clock::until(XrTime time) const {
  return std::chrono::nanoseconds(realtime_ ? std::max<XrTime>(time - now(), 0) : 0);
}

}  // namespace test_runtime
