#include "cuda/device/stage_timer.h"

#include <algorithm>
#include <iterator>

namespace voyager::cuda {

void StageTimer::begin() {
  count_ = 0;
  left_out_before_ = kStageCount;
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

void StageTimer::leave_out() {
  left_out_before_ = count_;
  timer_.mark(kLeftOut);
}

void StageTimer::collect(FrameStats& stats) const {
  for (size_t i = 0; i < count_; ++i)
    stats.milliseconds[ended_[i]] =
        timer_.milliseconds(i == left_out_before_ ? kLeftOut : i, i + 1);
  stats.total_milliseconds = timer_.milliseconds(0, count_);
  if (left_out_before_ < count_)
    stats.total_milliseconds -= timer_.milliseconds(left_out_before_, kLeftOut);
}

}  // namespace voyager::cuda
