#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace voyager::sog {

// Lossless, four bytes a pixel: r, g, b, a.
struct Image {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgba;

  uint64_t pixels() const { return uint64_t{width} * height; }
  const uint8_t* pixel(uint64_t i) const { return rgba.data() + 4 * i; }
};

// How many pixels an image may have.
struct PixelRange {
  uint64_t least, most;
};

// No file of such an image is larger: a lossless WebP that is larger than its pixels says nothing
// more.
inline uint64_t most_bytes(const PixelRange& pixels) {
  return (1 << 16) + 8 * pixels.most;
}

// Pixels that the images of several scenes may have together.
struct PixelBudget {
  uint64_t most, used = 0;
};

// A lossless WebP. Its size is held to `pixels`, and to what is left of `budget` (null: no limit),
// before memory is taken. `scene` and `file` are for messages. Throws Error(refused_input).
Image decode_webp(const std::string& scene, const std::string& file,
                  std::span<const std::byte> bytes, const PixelRange& pixels,
                  PixelBudget* budget = nullptr);

}  // namespace voyager::sog
