#include "runtime/scene/scale_histogram.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace voyager {
namespace {

constexpr double kShare = 0.1;

// So that the last bits of a machine's exponential do not reach the file.
double in_few_bits(double x) {
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  return std::ldexp(std::round(mantissa * 256) / 256, exponent);
}

float middle_of(const float* axes) {
  return std::max(std::min(axes[0], axes[1]), std::min(std::max(axes[0], axes[1]), axes[2]));
}

}  // namespace

void ScaleHistogram::add(const GaussianCloud& cloud, size_t begin, size_t end) {
  for (size_t i = begin; i < end; ++i) {
    if (!(cloud.opacity[i] >= kVisibleLogit)) continue;
    const float bin =
        (middle_of(cloud.log_scale.data() + 3 * i) - static_cast<float>(kLowest)) * kSteps;
    ++counts_[static_cast<size_t>(std::clamp(bin, 0.0f, static_cast<float>(kBins - 1)))];
  }
}

void ScaleHistogram::add(const ScaleHistogram& other) {
  std::transform(counts_.begin(), counts_.end(), other.counts_.begin(), counts_.begin(),
                 std::plus<>());
}

NativeScale ScaleHistogram::estimate() const {
  const uint64_t all = std::accumulate(counts_.begin(), counts_.end(), uint64_t{0});
  if (all == 0) return {};
  uint64_t below = 0;
  size_t bin = 0;
  while (static_cast<double>(below += counts_[bin]) < kShare * static_cast<double>(all)) ++bin;
  const double middle = kLowest + (static_cast<double>(bin) + 0.5) / kSteps;
  return {NativeSource::estimated, std::min(in_few_bits(std::exp(middle)), kMaxNativePixel),
          kPixelVariance};
}

NativeScale estimated_scale(const GaussianCloud& cloud) {
  ScaleHistogram histogram;
  histogram.add(cloud);
  return histogram.estimate();
}

NativeScale known_scale(const GaussianCloud& cloud) {
  return cloud.native.source == NativeSource::unknown ? estimated_scale(cloud) : cloud.native;
}

}  // namespace voyager
