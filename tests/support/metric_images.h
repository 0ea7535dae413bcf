#pragma once
// Small images for the metrics of tools/metrics.
#include <array>
#include <cmath>
#include <random>

#include "tools/metrics/screen_pair.h"

namespace voyager::test {

using tools::RgbaImage;

inline RgbaImage constant_image(size_t pixels, std::array<float, 3> colour) {
  RgbaImage image(4 * pixels, 1.0f);
  for (size_t i = 0; i < image.size(); ++i)
    if (i % 4 < 3) image[i] = colour[i % 4];
  return image;
}

inline RgbaImage grey_image(size_t pixels, float value) {
  return constant_image(pixels, {value, value, value});
}

inline void set_grey(RgbaImage& image, size_t pixel, float value) {
  for (size_t k = 0; k < 3; ++k) image[4 * pixel + k] = value;
}

inline RgbaImage random_image(size_t pixels, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  RgbaImage image(4 * pixels);
  for (float& value : image) value = uniform(random);
  return image;
}

// The other image mixed in, so that the two differ by as much.
inline RgbaImage mixed(const RgbaImage& image, const RgbaImage& other, float share) {
  RgbaImage sum = image;
  for (size_t i = 0; i < sum.size(); ++i) sum[i] += share * (other[i] - sum[i]);
  return sum;
}

// sRGB's code value of a linear one.
inline float code_value(double linear) {
  return static_cast<float>(linear <= 0.0031308 ? 12.92 * linear
                                                : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

}  // namespace voyager::test
