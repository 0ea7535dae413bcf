#pragma once
// The last stage: what was blended, over the background, in the host's format.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "runtime/base/workers.h"
#include "runtime/frame/backend.h"
#include "runtime/math/half.h"

namespace voyager {

inline uint8_t to_code(float value) {
  const float clamped = value > 0.0f ? (value < 1.0f ? value : 1.0f) : 0.0f;
  return static_cast<uint8_t>(clamped * 255.0f + 0.5f);
}

// Pixel x of a row that begins at `row`.
inline void store_color(ColorFormat format, const float (&rgba)[4], uint8_t* row, size_t x) {
  uint8_t* out = row + pixel_bytes(format) * x;
  switch (format) {
    case ColorFormat::none:
      break;
    case ColorFormat::rgba8:
      std::transform(rgba, rgba + 4, out, to_code);
      break;
    case ColorFormat::rgba16f:
      std::transform(rgba, rgba + 4, reinterpret_cast<uint16_t*>(out), float_to_half);
      break;
    case ColorFormat::rgba32f:
      std::copy_n(rgba, 4, reinterpret_cast<float*>(out));
      break;
  }
}

// pixel(i) gives the i-th pixel's premultiplied r, g, b and its transmittance
// as members; depth(i) its depth. Any type that converts to float.
template <class PixelAt, class DepthAt>
void resolve_image(const Image& image, const Vec3f& background, Workers& workers,
                   const PixelAt& pixel, const DepthAt& depth) {
  auto* const color = static_cast<uint8_t*>(image.color);
  const auto row = [&](size_t y) {
    for (size_t x = 0; x < image.width; ++x) {
      const size_t i = y * image.width + x;
      const auto& p = pixel(i);
      const float rgba[4] = {static_cast<float>(p.r + p.transmittance * background.x),
                             static_cast<float>(p.g + p.transmittance * background.y),
                             static_cast<float>(p.b + p.transmittance * background.z),
                             static_cast<float>(1 - p.transmittance)};
      if (color != nullptr) store_color(image.format, rgba, color + y * image.color_pitch, x);
      if (image.depth != nullptr)
        reinterpret_cast<float*>(reinterpret_cast<uint8_t*>(image.depth) +
                                 y * image.depth_pitch)[x] = static_cast<float>(depth(i));
    }
  };
  workers.for_blocks(image.height, 16, [&](size_t begin, size_t end) {
    for (size_t y = begin; y < end; ++y) row(y);
  });
}

}  // namespace voyager
