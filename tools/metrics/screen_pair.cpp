#include "tools/metrics/screen_pair.h"

#include <cassert>

namespace voyager::tools {

ScreenPair screen_pair(const RgbaImage& image, const RgbaImage& expected, size_t width) {
  assert(width > 0 && image.size() % (4 * width) == 0 && image.size() == expected.size());
  ScreenPair pair;
  const size_t pixels = image.size() / 4;
  for (auto* planes : {&pair.image, &pair.expected})
    planes->fill({width, std::vector<double>(pixels)});
  for (size_t pixel = 0; pixel < pixels; ++pixel) {
    const float *seen = &image[4 * pixel], *wanted = &expected[4 * pixel];
    const bool finite = is_finite(seen) && is_finite(wanted);
    if (!finite) pair.not_finite.push_back(pixel);
    for (size_t channel = 0; channel < 3; ++channel) {
      pair.image[channel].values[pixel] = finite ? on_screen(seen[channel]) : 1;
      pair.expected[channel].values[pixel] = finite ? on_screen(wanted[channel]) : 0;
    }
  }
  return pair;
}

}  // namespace voyager::tools
