#include "tools/report/thumbnail.h"

#include <array>
#include <cmath>
#include <cstdint>

#include "tools/image_file.h"

namespace voyager::tools {
namespace {

constexpr size_t kWidest = 480;  // pixels

// Whole pixels are averaged; what is left over at the right and below is cut off.
std::string encode(const RgbaImage& image, size_t width) {
  const size_t step = (width + kWidest - 1) / kWidest, height = image.size() / 4 / width;
  const size_t w = width / step, h = std::max<size_t>(height / step, 1);
  std::vector<uint8_t> rgba(4 * w * h, 255);
  for (size_t y = 0; y < h; ++y)
    for (size_t x = 0; x < w; ++x)
      for (size_t channel = 0; channel < 3; ++channel) {
        double sum = 0;
        size_t count = 0;
        for (size_t j = y * step; j < std::min(height, (y + 1) * step); ++j)
          for (size_t i = x * step; i < (x + 1) * step; ++i, ++count) {
            const float value = image[4 * (j * width + i) + channel];
            sum += std::isfinite(value) ? on_screen(value) : 1.0;
          }
        rgba[4 * (y * w + x) + channel] =
            static_cast<uint8_t>(std::lround(255 * sum / static_cast<double>(count)));
      }
  return encode_png(static_cast<uint32_t>(w), static_cast<uint32_t>(h), rgba);
}

std::array<float, 3> heat(float value) {
  constexpr std::array<float, 3> kStops[] = {{0, 0, 0.02f},
                                             {0.23f, 0.06f, 0.44f},
                                             {0.72f, 0.21f, 0.33f},
                                             {0.98f, 0.65f, 0.2f},
                                             {1, 1, 0.9f}};
  const float at = std::clamp(value, 0.0f, 1.0f) * 4;
  const auto below = std::min(static_cast<size_t>(at), size_t{3});
  const float share = at - static_cast<float>(below);
  std::array<float, 3> colour{};
  for (size_t i = 0; i < 3; ++i)
    colour[i] = (1 - share) * kStops[below][i] + share * kStops[below + 1][i];
  return colour;
}

}  // namespace

std::string picture_png(const RgbaImage& image, size_t width) {
  return encode(image, width);
}

std::string difference_png(const std::vector<float>& values, size_t width) {
  RgbaImage image(4 * values.size(), 1);
  for (size_t i = 0; i < values.size(); ++i) {
    const auto colour = heat(values[i]);
    std::copy(colour.begin(), colour.end(), image.begin() + static_cast<std::ptrdiff_t>(4 * i));
  }
  return encode(image, width);
}

}  // namespace voyager::tools
