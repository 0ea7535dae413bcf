#include "tools/image_error.h"

#include <algorithm>
#include <cassert>

namespace voyager::tools {

ImageError image_error(const std::vector<RgbaImage>& images,
                       const std::vector<RgbaImage>& expected) {
  assert(images.size() == expected.size());
  ImageError error;
  double squares = 0, values = 0;
  for (size_t i = 0; i < images.size(); ++i) {
    assert(images[i].size() == expected[i].size());
    for (size_t k = 0; k < images[i].size(); ++k) {
      if (k % 4 == 3) continue;
      const double difference =
          double{std::clamp(images[i][k], 0.0f, 1.0f)} - std::clamp(expected[i][k], 0.0f, 1.0f);
      squares += difference * difference;
      error.largest = std::max(error.largest, std::fabs(difference));
      ++values;
    }
  }
  if (squares > 0) error.psnr = 10 * std::log10(values / squares);
  return error;
}

}  // namespace voyager::tools
