#pragma once
// An image in host memory with room between its rows and around it.
#include <algorithm>
#include <cstring>
#include <vector>

#include "runtime/frame/backend.h"

namespace voyager::test {

class GuardedPlane {
 public:
  GuardedPlane(size_t row_bytes, size_t rows)
      : row_bytes_(row_bytes), rows_(rows), bytes_(2 * kMargin + rows * pitch(), kGuard) {}

  uint8_t* data() { return row_bytes_ == 0 ? nullptr : bytes_.data() + kMargin; }
  size_t pitch() const { return row_bytes_ + 20; }
  // Bytes written to outside the rows.
  size_t spilled() const {
    const std::vector<uint8_t> rows = packed();
    return written(bytes_) - written(rows);
  }
  bool untouched() const { return written(bytes_) == 0; }
  // The rows without what is between them.
  std::vector<uint8_t> packed() const {
    std::vector<uint8_t> rows;
    for (size_t y = 0; y < rows_; ++y) {
      const auto row = bytes_.begin() + static_cast<std::ptrdiff_t>(kMargin + y * pitch());
      rows.insert(rows.end(), row, row + static_cast<std::ptrdiff_t>(row_bytes_));
    }
    return rows;
  }

 private:
  static constexpr size_t kMargin = 64;
  static constexpr uint8_t kGuard = 0xa5;

  static size_t written(const std::vector<uint8_t>& bytes) {
    return bytes.size() - static_cast<size_t>(std::count(bytes.begin(), bytes.end(), kGuard));
  }

  size_t row_bytes_, rows_;
  std::vector<uint8_t> bytes_;
};

struct GuardedImage {
  GuardedImage(ColorFormat color_format, uint32_t w, uint32_t h)
      : format(color_format),
        width(w),
        height(h),
        color(pixel_bytes(format) * w, h),
        depth(sizeof(float) * w, h) {}

  Image image() {
    return {format,       width,         height,
            color.data(), color.pitch(), reinterpret_cast<float*>(depth.data()),
            depth.pitch()};
  }
  size_t spilled() const { return color.spilled() + depth.spilled(); }
  bool untouched() const { return color.untouched() && depth.untouched(); }

  ColorFormat format;
  uint32_t width, height;
  GuardedPlane color, depth;
};

}  // namespace voyager::test
