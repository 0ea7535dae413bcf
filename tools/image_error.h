#pragma once
#include <cmath>
#include <vector>

namespace voyager::tools {

using RgbaImage = std::vector<float>;  // r, g, b, a of each pixel

struct ImageError {
  double psnr = INFINITY;  // dB, peak 1
  double largest = 0;      // 1 is a channel's whole range
};

// Of colours as a screen shows them, clamped to [0, 1]; over the pixels of all images together.
// Both have the same sizes.
ImageError image_error(const std::vector<RgbaImage>& images,
                       const std::vector<RgbaImage>& expected);

}  // namespace voyager::tools
