#pragma once
#include <cmath>
#include <vector>

#include "tools/metrics/screen_pair.h"

namespace voyager::tools {

// Of absolute differences of channel values, where 1 is a channel's whole range.
struct ImageError {
  double psnr = INFINITY;  // dB, peak 1: -10 log10 of the mean square; infinite where all are 0
  double largest = 0;
  double p999 = 0;  // the least one that 99.9 % of all do not exceed: of n, the ⌈0.999 n⌉-th
  size_t not_finite = 0;  // pixels with a colour that is not finite, in either: difference 1
};

// Of colours as a screen shows them, clamped to [0, 1], alpha left out; over the three values of
// each pixel of all images together. Both have the same sizes.
ImageError image_error(const std::vector<RgbaImage>& images,
                       const std::vector<RgbaImage>& expected);

}  // namespace voyager::tools
