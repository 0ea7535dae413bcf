#pragma once
// How near frames come to those of another backend.
#include <algorithm>
#include <cstdio>
#include <string>

#include "tests/support/render_scene.h"

namespace voyager::test {

// Collects pairs of frames. A pixel beyond 2/255 is one where a threshold (α*, the end of
// a pixel) fell to the other side: such pixels are counted, and may be one in a thousand;
// so may those whose depth is another splat's.
class Agreement {
 public:
  explicit Agreement(std::string name) : name_(std::move(name)) {}

  // The cuts are equal, and nothing is NaN or left out of `found`.
  void add(const Frame& found, const Frame& expected) {
    EXPECT_TRUE(found.cut == expected.cut)
        << name_ << ": cuts of " << found.cut.size() << " and " << expected.cut.size() << " nodes";
    EXPECT_EQ(found.stats.pairs_dropped, 0u) << name_;
    expect_no_nan(found);
    const Difference d = compare(found, expected);
    const size_t pixels = expected.rgba.size() / 4;
    ++frames_;
    pixels_ += pixels;
    rough_ += d.rough;
    squares_ += static_cast<double>(pixels) * std::pow(10.0, -d.psnr / 10);
    largest_smooth_ = std::max(largest_smooth_, d.largest_smooth);
    if (pixels >= kWholeFrame) least_ = std::min(least_, d.psnr);
    for (size_t i = 0; i < pixels; ++i) {
      depths_ += depth_bits(found, i) != depth_bits(expected, i);
      covered_ += expected.rgba[4 * i + 3] > 0.1f;
    }
  }

  // Says how near they are, and expects them to be.
  void expect(double least_psnr = 60) const {
    const double psnr =
        squares_ > 0 ? -10 * std::log10(squares_ / static_cast<double>(pixels_)) : INFINITY;
    std::printf(
        "%s: %zu frames, %.1f dB (least %.1f), %.2f/255 but for %zu of %zu pixels, depth of %zu\n",
        name_.c_str(), frames_, psnr, std::min(least_, psnr), 255 * largest_smooth_, rough_,
        pixels_, depths_);
    EXPECT_GT(covered_, pixels_ / 50) << name_ << ": nothing to see";
    EXPECT_GE(psnr, least_psnr) << name_;
    EXPECT_GE(least_, least_psnr) << name_;
    EXPECT_LE(rough_, pixels_ / 1000) << name_;
    EXPECT_LE(depths_, pixels_ / 1000) << name_;
  }

 private:
  // In a smaller frame one pixel on the other side is all of the error.
  static constexpr size_t kWholeFrame = 4096;

  static uint32_t depth_bits(const Frame& frame, size_t i) {
    return frame.depth.empty() ? 0 : std::bit_cast<uint32_t>(frame.depth[i]);
  }

  std::string name_;
  size_t frames_ = 0, pixels_ = 0, rough_ = 0, depths_ = 0, covered_ = 0;
  double squares_ = 0, least_ = INFINITY, largest_smooth_ = 0;
};

}  // namespace voyager::test
