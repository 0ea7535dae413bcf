#include "tools/supersample.h"

#include <algorithm>

#include "runtime/frame/resolve.h"

namespace voyager::tools {

std::vector<float> mean_of_samples(const std::vector<float>& samples, uint32_t width,
                                   uint32_t height, uint32_t side) {
  constexpr size_t kChannels = 4;
  const size_t row_values = size_t{width} * side * kChannels;
  const double share = 1.0 / (static_cast<double>(side) * side);
  std::vector<float> means(size_t{width} * height * kChannels);
  std::vector<double> sums(size_t{width} * kChannels);
  for (size_t y = 0; y < height; ++y) {
    std::fill(sums.begin(), sums.end(), 0.0);
    for (size_t row = y * side; row < (y + 1) * side; ++row) {
      const float* from = samples.data() + row * row_values;
      for (size_t i = 0; i < row_values; ++i)
        sums[i / (kChannels * side) * kChannels + i % kChannels] += double{from[i]};
    }
    for (size_t i = 0; i < sums.size(); ++i)
      means[y * sums.size() + i] = static_cast<float>(sums[i] * share);
  }
  return means;
}

std::vector<uint8_t> to_rgba8(const std::vector<float>& rgba) {
  std::vector<uint8_t> codes(rgba.size());
  std::transform(rgba.begin(), rgba.end(), codes.begin(), to_code);
  return codes;
}

}  // namespace voyager::tools
