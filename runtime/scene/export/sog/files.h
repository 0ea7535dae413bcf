#pragma once
// The files of a .sog.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace voyager::sog_export {

// Four bytes a pixel, rows of a width.
struct Image {
  uint32_t width, height;
  std::vector<uint8_t> rgba;

  uint8_t* pixel(size_t i) { return rgba.data() + 4 * i; }
};
// Black and opaque.
Image blank_image(uint32_t width, uint32_t height);
// Of at least so many pixels, both sides multiples of 4.
Image image_of(uint64_t pixels);
inline constexpr uint64_t kMostPixels = uint64_t{16380} * 16380;  // of a WebP, sides as above

// Lossless, colours of transparent pixels included. Throws std::bad_alloc.
std::vector<std::byte> encode_webp(const Image& image);

using NamedFiles = std::vector<std::pair<std::string, std::vector<std::byte>>>;
// Stored as they are; the same bytes for the same files. Throws std::bad_alloc.
std::vector<std::byte> zip_of(const NamedFiles& files);

}  // namespace voyager::sog_export
