#pragma once
// FLIP, the difference that one sees when two images alternate on a screen: Andersson, Nilsson,
// Akenine-Möller, Oskarsson, Åström, Fairchild, "FLIP: A Difference Evaluator for Alternating
// Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020, for images of low dynamic range,
// with luminance over 116 as the authors' erratum has it.
#include <numbers>

#include "tools/metrics/screen_pair.h"

namespace voyager::tools {

// 3840 pixels on 0.7 m, seen from 0.7 m: 67.02.
inline constexpr double kFlipPixelsPerDegree = 0.7 * (3840 / 0.7) * (std::numbers::pi / 180);

struct Flip {
  double mean = 0;         // 0 to 1
  std::vector<float> map;  // 0 to 1 for each pixel, row by row
};

// Of colours as a screen shows them: sRGB code values, clamped to [0, 1], alpha left out. Equal
// images have 0; the order of the two does not matter. Beyond the border the pixels at it are
// repeated, so that images may be of any size. Pixels that are not finite have 1, and their
// neighbours see white against black.
// Both images have the same size, and a pixel at least; width > 0. Throws Error(invalid_argument)
// for pixels_per_degree outside [1, 1000]. Takes 18 doubles a pixel.
Flip flip(const RgbaImage& image, const RgbaImage& expected, size_t width,
          double pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace voyager::tools
