#include "tools/metrics/popping.h"

#include <cassert>

namespace voyager::tools {

void Popping::add(const RgbaImage& frame, const RgbaImage& reference) {
  assert(!frame.empty() && frame.size() == reference.size());
  if (frames_ > 0) {
    const double change = excess(frame, reference);
    sum_ += change;
    if (change > worst_) {
      worst_ = change;
      worst_frame_ = frames_;
    }
  }
  frame_ = frame;
  reference_ = reference;
  ++frames_;
}

double Popping::excess(const RgbaImage& frame, const RgbaImage& reference) const {
  assert(frame.size() == frame_.size());
  double sum = 0;
  for (size_t i = 0; i < frame.size(); i += 4) {
    if (!is_finite(&frame[i]) || !is_finite(&reference[i]) || !is_finite(&frame_[i]) ||
        !is_finite(&reference_[i])) {
      sum += 3;
      continue;
    }
    for (size_t k = i; k < i + 3; ++k)
      sum += std::max(0.0, std::fabs(on_screen(frame[k]) - on_screen(frame_[k])) -
                               std::fabs(on_screen(reference[k]) - on_screen(reference_[k])));
  }
  return 255 * sum / (0.75 * static_cast<double>(frame.size()));
}

}  // namespace voyager::tools
