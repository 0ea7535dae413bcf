#include "tools/report/frame_energy.h"

namespace voyager::tools {

void FrameEnergy::frame(size_t drawn) {
  drawn_ = drawn;
  if (drawn != untimed_ || meter_ == nullptr) return;
  watch_ = Stopwatch();
  before_ = meter_->joules();
}

std::optional<double> FrameEnergy::joules_a_frame() const {
  if (!before_ || drawn_ <= untimed_ || wants_more()) return std::nullopt;
  const std::optional<double> after = meter_->joules();
  if (!after) return std::nullopt;
  return (*after - *before_) / static_cast<double>(drawn_ - untimed_);
}

}  // namespace voyager::tools
