#include "tools/image_file.h"

#include <fmt/core.h>
#include <png.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/file.h"

namespace voyager::tools {
namespace {

void write_file(const std::string& path, std::span<const std::byte> bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

void write_pfm(const std::string& path, const char* magic, uint32_t width, uint32_t height,
               size_t channels, const auto& value) {
  std::string bytes = fmt::format("{}\n{} {}\n-1.0\n", magic, width, height);
  const size_t header = bytes.size(), row = width * channels;
  bytes.resize(header + row * height * sizeof(float));
  for (size_t y = 0; y < height; ++y)
    for (size_t i = 0; i < row; ++i) {
      const float v = value((height - 1 - y) * width + i / channels, i % channels);
      std::memcpy(bytes.data() + header + (y * row + i) * sizeof v, &v, sizeof v);
    }
  write_file(path, std::as_bytes(std::span(bytes)));
}

}  // namespace

std::string encode_png(uint32_t width, uint32_t height, std::span<const uint8_t> rgba) {
  std::vector<uint8_t> rgb(size_t{3} * width * height);
  for (size_t i = 0; i < size_t{width} * height; ++i)
    std::copy_n(rgba.data() + 4 * i, 3, rgb.data() + 3 * i);
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr) == 0)
    throw Error(ErrorCode::internal, std::string("PNG: ") + image.message);
  bytes.resize(size);
  return bytes;
}

void write_png(const std::string& path, uint32_t width, uint32_t height,
               std::span<const uint8_t> rgba) {
  const std::string bytes = encode_png(width, height, rgba);
  write_file(path, std::as_bytes(std::span(bytes)));
}

void write_pfm_rgb(const std::string& path, uint32_t width, uint32_t height,
                   std::span<const float> rgba) {
  write_pfm(path, "PF", width, height, 3,
            [&](size_t pixel, size_t channel) { return rgba[4 * pixel + channel]; });
}

void write_pfm_grey(const std::string& path, uint32_t width, uint32_t height,
                    std::span<const float> values) {
  write_pfm(path, "Pf", width, height, 1, [&](size_t pixel, size_t) { return values[pixel]; });
}

}  // namespace voyager::tools
