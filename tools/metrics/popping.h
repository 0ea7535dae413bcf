#pragma once
// Temporal stability along a path: change from frame to frame beyond the reference's own.
//   excess(i) = 255 · mean of max(0, |T_i − T_(i−1)| − |R_i − R_(i−1)|)
// over the pixels and r, g, b, of frames T against those of the reference R, as a screen shows
// them. What stands still or moves as the reference does adds nothing, however wrong it is.
#include "tools/metrics/screen_pair.h"

namespace voyager::tools {

class Popping {
 public:
  // The next frame, and the reference's from the same camera; all of one size. Keeps a copy of
  // the two. A pixel that is not finite in these or in the frame before counts as a change of 255.
  void add(const RgbaImage& frame, const RgbaImage& reference);

  // In 1/255 of a channel's range, 0 to 255; 0 of fewer than two frames.
  double mean() const { return frames_ < 2 ? 0 : sum_ / static_cast<double>(frames_ - 1); }
  double worst() const { return worst_; }
  // The first with the worst excess, against the frame before it; frames count from 0. 0: none.
  size_t worst_frame() const { return worst_frame_; }

 private:
  double excess(const RgbaImage& frame, const RgbaImage& reference) const;

  RgbaImage frame_, reference_;  // the last ones
  size_t frames_ = 0, worst_frame_ = 0;
  double sum_ = 0, worst_ = 0;
};

}  // namespace voyager::tools
