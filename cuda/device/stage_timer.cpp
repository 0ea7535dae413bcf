#include "cuda/device/stage_timer.h"

#include <algorithm>
#include <iterator>

namespace voyager::cuda {

void StageTimer::begin() {
  count_ = 0;
  timer_.mark(0);
}

void StageTimer::end(Stage stage) {
  ended_[count_] = stage;
  ++count_;
  timer_.mark(count_);
}

void StageTimer::go_back_to(Stage stage) {
  const auto last = std::find(ended_, ended_ + count_, stage);
  count_ = static_cast<size_t>(std::distance(ended_, last)) + 1;
}

void StageTimer::collect(FrameStats& stats) const {
  for (size_t i = 0; i < count_; ++i) stats.milliseconds[ended_[i]] = timer_.milliseconds(i, i + 1);
  stats.total_milliseconds = timer_.milliseconds(0, count_);
}

}  // namespace voyager::cuda
