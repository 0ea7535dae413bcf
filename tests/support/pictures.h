#pragma once
// Pictures that programs wrote.
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace voyager::test {

struct Picture {
  uint32_t width = 0, height = 0;
  std::vector<float> values;  // PNG: code values, 0 to 255

  size_t channels() const { return values.size() / (size_t{width} * height); }
};

inline Picture read_png(const std::string& path) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  Picture picture;
  EXPECT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0) << path << image.message;
  image.format = PNG_FORMAT_RGB;
  std::vector<uint8_t> bytes(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, bytes.data(), 0, nullptr), 0) << image.message;
  picture.width = image.width;
  picture.height = image.height;
  picture.values.assign(bytes.begin(), bytes.end());
  return picture;
}

// Rows from the top.
inline Picture read_pfm(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string magic;
  Picture picture;
  float scale = 0;
  file >> magic >> picture.width >> picture.height >> scale;
  file.get();
  EXPECT_LT(scale, 0) << path;
  const size_t row = size_t{picture.width} * (magic == "PF" ? 3 : 1);
  picture.values.resize(row * picture.height);
  for (uint32_t y = picture.height; y-- > 0;)
    file.read(reinterpret_cast<char*>(&picture.values[row * y]),
              static_cast<std::streamsize>(row * sizeof(float)));
  EXPECT_TRUE(file.good()) << path;
  return picture;
}

inline float largest_difference(const Picture& a, const Picture& b) {
  if (a.width != b.width || a.height != b.height) return INFINITY;
  float most = 0;
  for (size_t i = 0; i < a.values.size(); ++i)
    most = std::max(most, std::abs(a.values[i] - b.values[i]));
  return most;
}

}  // namespace voyager::test
