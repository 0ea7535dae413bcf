#pragma once
// Pictures for a page: PNGs of at most 480 pixels' width.
#include <string>
#include <vector>

#include "tools/metrics/screen_pair.h"

namespace voyager::tools {

std::string picture_png(const RgbaImage& image, size_t width);
// Values from 0 (black) over blue, red and yellow to 1 (white).
std::string difference_png(const std::vector<float>& values, size_t width);

}  // namespace voyager::tools
