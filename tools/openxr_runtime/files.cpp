#include "files.h"

#include <png.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace test_runtime {

void write_bytes(const std::string& path, std::span<const std::byte> bytes) {
  const std::string temporary = path + ".part-" + std::to_string(::getpid());
  std::FILE* file = nullptr;
  const auto fail = [&] {
    const std::string reason = std::strerror(errno);
    if (file) std::remove(temporary.c_str());
    throw std::runtime_error(path + ": " + reason);
  };
  std::error_code ignored;  // where there is no folder, opening says so
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), ignored);
  file = std::fopen(temporary.c_str(), "wbx");  // x: no file of another is emptied
  if (!file) fail();
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  if (std::fclose(file) != 0 || !written) fail();
  if (std::rename(temporary.c_str(), path.c_str()) != 0) fail();
}

void write_text(const std::string& path, const std::string& text) {
  write_bytes(path, std::as_bytes(std::span(text)));
}

void write_png(const std::string& path, uint32_t width, uint32_t height,
               std::span<const uint8_t> rgb) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  image.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<std::byte> bytes(size);
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr) == 0)
    throw std::runtime_error(path + ": PNG: " + image.message);
  write_bytes(path, std::span(bytes).first(size));
}

void write_pfm(const std::string& path, uint32_t width, uint32_t height,
               std::span<const float> values) {
  const std::string header =
      "Pf\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
  const size_t row = size_t{width} * sizeof(float);
  std::vector<std::byte> bytes(header.size() + row * height);
  std::memcpy(bytes.data(), header.data(), header.size());
  for (uint32_t y = 0; y < height; ++y)
    std::memcpy(&bytes[header.size() + row * y], &values[size_t{width} * (height - 1 - y)], row);
  write_bytes(path, bytes);
}

}  // namespace test_runtime
