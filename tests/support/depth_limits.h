#pragma once
// Depth limits for frames.
#include <random>
#include <vector>

#include "tests/support/render_scene.h"

namespace voyager::test {

// In metres, with padding behind each row that would end every pixel.
class LimitImage {
 public:
  LimitImage(const Camera& camera, float everywhere)
      : width_(camera.width), values_((width_ + kPadding) * camera.height, -1.0f) {
    for (size_t y = 0; y < camera.height; ++y)
      for (size_t x = 0; x < width_; ++x) at(x, y) = everywhere;
  }
  float& at(size_t x, size_t y) { return values_[y * (width_ + kPadding) + x]; }
  // Valid as long as this is.
  DepthLimits limits(const DepthEncoding& encoding = {}) const {
    return {values_.data(), (width_ + kPadding) * sizeof(float), encoding};
  }

 private:
  static constexpr size_t kPadding = 3;
  size_t width_;
  std::vector<float> values_;
};

inline FrameInput limited(FrameInput input, const LimitImage& image) {
  input.eyes[0].limits = image.limits();
  return input;
}

// Every kind of limit beside every other: none, what no splat is in front of, the depths of
// splats and just short of them, and between. Blocks that are all alike let whole tiles
// end early. `frame` is the same without limits.
inline LimitImage random_limits(const FrameInput& input, const Frame& frame, uint32_t seed) {
  std::mt19937 random(seed);
  LimitImage image(input.eyes[0].camera, 0);
  const auto any = [&](size_t i) {
    switch (random() % 8) {
      case 0:
        return INFINITY;
      case 1:
        return NAN;
      case 2:
        return 1e-30f;
      case 3:
        return frame.depth[i];
      case 4:
        return std::nextafter(frame.depth[i], 0.0f);
      case 5:
        return frame.depth[random() % frame.depth.size()];
      default:
        return 0.2f + static_cast<float>(random() % 40000) * 1e-3f;
    }
  };
  constexpr size_t kBlock = 24;
  std::vector<float> whole;  // a block; NaN where its pixels differ
  const size_t columns = frame.width / kBlock + 1;
  for (size_t i = 0; i < columns * (frame.height / kBlock + 1); ++i)
    whole.push_back(random() % 2 ? 4.0f + static_cast<float>(random() % 30) : NAN);
  for (size_t y = 0; y < frame.height; ++y)
    for (size_t x = 0; x < frame.width; ++x) {
      const float block = whole[y / kBlock * columns + x / kBlock];
      image.at(x, y) = std::isnan(block) ? any(y * frame.width + x) : block;
    }
  return image;
}

}  // namespace voyager::test
