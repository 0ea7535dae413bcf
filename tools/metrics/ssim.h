#pragma once
// Structural similarity: Wang, Bovik, Sheikh, Simoncelli, "Image quality assessment: from error
// visibility to structural similarity", 2004.
#include "tools/metrics/screen_pair.h"

namespace voyager::tools {

inline constexpr size_t kSsimWindow = 11;  // pixels along each side; Gaussian, σ = 1.5 pixels

// From -1 to 1, which is of equal images. Of r, g and b by themselves, then their mean, as 3DGS
// has it: on luma alone a wrong hue would be no error. The mean is over the windows that lie
// wholly inside, as in the paper's own program: no border is made up. Pixels that are not finite
// are white against black.
// Both images have the same size; width > 0. Throws Error(unsupported) for one that is smaller
// than a window. Takes 14 doubles a pixel.
double ssim(const RgbaImage& image, const RgbaImage& expected, size_t width);

}  // namespace voyager::tools
