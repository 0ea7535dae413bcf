// What FLIP promises, whatever the images.
#include "tools/metrics/flip.h"

#include <gtest/gtest.h>

#include "runtime/base/error.h"
#include "tests/support/metric_images.h"
#include "tools/metrics/flip_colour.h"
#include "tools/metrics/flip_filters.h"

namespace voyager::tools {
namespace flip_test {
namespace {

using test::code_value;
using test::constant_image;
using test::grey_image;
using test::mixed;
using test::random_image;
using test::set_grey;

constexpr size_t kWidth = 41, kHeight = 31, kPixels = kWidth * kHeight;
constexpr size_t kMiddle = kHeight / 2 * kWidth + kWidth / 2;

TEST(Flip, OfEqualImagesIsNoneAndOfOthersDoesNotDependOnTheirOrder) {
  const RgbaImage a = random_image(kPixels, 1), b = random_image(kPixels, 2);
  EXPECT_EQ(flip(a, a, kWidth).mean, 0);
  const Flip forth = flip(a, b, kWidth), back = flip(b, a, kWidth);
  EXPECT_EQ(forth.map, back.map);
  for (const float value : forth.map) {
    EXPECT_GT(value, 0);
    EXPECT_LE(value, 1);
  }
}

// L* is 0 and 100, so HyAB^0.7 is 100^0.7: beyond the knee.
TEST(Flip, OfConstantColoursIsTheirColourError) {
  const double share = std::pow(100, 0.7) / largest_colour_distance();
  EXPECT_NEAR(flip(grey_image(kPixels, 1), grey_image(kPixels, 0), kWidth).mean,
              0.95 + 0.05 * (share - 0.4) / 0.6, 1e-6);
  const RgbaImage green = constant_image(kPixels, {0, 1, 0}),
                  blue = constant_image(kPixels, {0, 0, 1});
  EXPECT_NEAR(flip(green, blue, kWidth).mean, 1, 1e-6);
}

TEST(Flip, GrowsWithTheDifference) {
  double last = 0;
  for (const float value : {0.2f, 0.21f, 0.25f, 0.4f, 0.6f, 0.8f, 1.0f}) {
    const double error = flip(grey_image(9, value), grey_image(9, 0.19f), 3).mean;
    EXPECT_GT(error, last);
    last = error;
  }
  const RgbaImage a = random_image(kPixels, 1), b = random_image(kPixels, 2);
  last = 0;
  for (const float share : {0.01f, 0.1f, 0.3f, 1.0f}) {
    const double error = flip(mixed(a, b, share), a, kWidth).mean;
    EXPECT_GT(error, last);
    last = error;
  }
}

// Eyes see as grey what is fine enough.
TEST(Flip, OfDetailFallsWithPixelsPerDegree) {
  RgbaImage board = grey_image(kPixels, 0);
  for (size_t pixel = 0; pixel < kPixels; pixel += 2) set_grey(board, pixel, 1);
  const RgbaImage grey = grey_image(kPixels, code_value(0.5));
  double last = INFINITY;
  for (const double pixels_per_degree : {10.0, 25.0, 40.0, 60.0}) {
    const float error = flip(board, grey, kWidth, pixels_per_degree).map[kMiddle];
    EXPECT_LT(error, 0.8 * last) << pixels_per_degree;
    last = error;
  }
}

// A dot of one pixel: no edge in its middle, and the same point response along both axes.
TEST(Flip, OfADotIsItsColourErrorRaisedByThePoint) {
  constexpr double ground = 0.1, rise = 0.6;  // linear
  const RgbaImage plain = grey_image(kPixels, code_value(ground));
  RgbaImage dot = plain;
  set_grey(dot, kMiddle, code_value(ground + rise));
  const FlipFilters filters = flip_filters(kFlipPixelsPerDegree);
  const auto middle = [](const Kernel& kernel) { return kernel[kernel.size() / 2]; };
  const double light = middle(filters.light) * middle(filters.light) * rise;
  const double lightness = 116 * (std::cbrt(ground + light) - std::cbrt(ground));
  const double colours = colour_error(std::pow(lightness, 0.7));
  const double point = std::fabs(middle(filters.point)) * middle(filters.smooth) * rise;
  const float error = flip(dot, plain, kWidth).map[kMiddle];
  EXPECT_NEAR(error, std::pow(colours, 1 - std::sqrt(point)), 1e-6);
  EXPECT_GT(error, 1.05 * colours);
}

// A step up from one column to the next. There the edge responds with the whole rise.
TEST(Flip, OfAnEdgeIsItsColourErrorRaisedByTheEdge) {
  constexpr double ground = 0.1, rise = 0.05;
  const RgbaImage plain = grey_image(kPixels, code_value(ground));
  RgbaImage edge = plain;
  for (size_t pixel = 0; pixel < kPixels; ++pixel)
    if (pixel % kWidth >= kWidth / 2) set_grey(edge, pixel, code_value(ground + rise));
  const FlipFilters filters = flip_filters(kFlipPixelsPerDegree);
  const double light = 0.5 * (1 + filters.light[filters.light.size() / 2]) * rise;
  const double lightness = 116 * (std::cbrt(ground + light) - std::cbrt(ground));
  const double colours = colour_error(std::pow(lightness, 0.7));
  const float error = flip(edge, plain, kWidth).map[kMiddle];
  EXPECT_NEAR(error, std::pow(colours, 1 - std::sqrt(rise / std::sqrt(2.0))), 1e-6);
  EXPECT_GT(error, 1.05 * colours);
}

TEST(Flip, TreatsRowsAndColumnsAlike) {
  constexpr size_t width = 13, height = 7;
  const auto transposed = [](const auto& values, size_t channels) {
    auto turned = values;
    for (size_t y = 0; y < height; ++y)
      for (size_t x = 0; x < width; ++x)
        for (size_t k = 0; k < channels; ++k)
          turned[(x * height + y) * channels + k] = values[(y * width + x) * channels + k];
    return turned;
  };
  const RgbaImage a = random_image(width * height, 1), b = random_image(width * height, 2);
  const std::vector<float> upright = transposed(flip(a, b, width).map, 1),
                           turned = flip(transposed(a, 4), transposed(b, 4), height).map;
  for (size_t i = 0; i < turned.size(); ++i) EXPECT_NEAR(turned[i], upright[i], 1e-6);
}

TEST(Flip, IsOfColoursAsAScreenShowsThem) {
  EXPECT_EQ(flip({1.5f, -3.0f, 0.25f, 0.0f}, {1.0f, 0.0f, 0.25f, 1.0f}, 1).mean, 0);
}

TEST(Flip, OfAPixelThatIsNotFiniteIsOne) {
  const RgbaImage plain = grey_image(kPixels, 0.5f);
  for (const float value : {NAN, INFINITY, -INFINITY}) {
    RgbaImage broken = plain;
    broken[4 * kMiddle + 1] = value;
    for (const Flip& difference :
         {flip(broken, plain, kWidth), flip(plain, broken, kWidth), flip(broken, broken, kWidth)}) {
      EXPECT_EQ(difference.map[kMiddle], 1);
      EXPECT_GT(difference.map[kMiddle + 1], 0.1);
      EXPECT_TRUE(std::isfinite(difference.mean));
    }
  }
  EXPECT_EQ(flip(grey_image(4, NAN), grey_image(4, NAN), 2).mean, 1);
}

TEST(Flip, RefusesPixelsPerDegreeThatNoEyeHas) {
  const RgbaImage image = grey_image(4, 0.5f);
  EXPECT_NO_THROW(flip(image, image, 2, 1));
  for (const double wrong : {0.0, 0.99, -67.0, 1001.0, double{NAN}, double{INFINITY}})
    EXPECT_THROW(flip(image, image, 2, wrong), Error) << wrong;
}

}  // namespace
}  // namespace flip_test
}  // namespace voyager::tools
