#include "tools/metrics/image_error.h"

#include <algorithm>
#include <cassert>

#include "tools/statistics.h"

namespace voyager::tools {

ImageError image_error(const std::vector<RgbaImage>& images,
                       const std::vector<RgbaImage>& expected) {
  assert(images.size() == expected.size());
  ImageError error;
  double squares = 0;
  std::vector<double> differences;
  for (size_t i = 0; i < images.size(); ++i) {
    const ScreenPair pair = screen_pair(images[i], expected[i], 1);
    error.not_finite += pair.not_finite.size();
    for (size_t channel = 0; channel < 3; ++channel)
      for (size_t k = 0; k < images[i].size() / 4; ++k) {
        differences.push_back(
            std::fabs(pair.image[channel].values[k] - pair.expected[channel].values[k]));
        squares += differences.back() * differences.back();
        error.largest = std::max(error.largest, differences.back());
      }
  }
  if (squares > 0) error.psnr = 10 * std::log10(static_cast<double>(differences.size()) / squares);
  error.p999 = percentile(std::move(differences), 0.999);
  return error;
}

}  // namespace voyager::tools
