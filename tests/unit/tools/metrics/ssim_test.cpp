#include "tools/metrics/ssim.h"

#include <gtest/gtest.h>

#include "runtime/base/error.h"
#include "tests/support/metric_images.h"

namespace voyager::tools {
namespace ssim_test {
namespace {

using test::constant_image;
using test::grey_image;
using test::mixed;
using test::random_image;
using test::set_grey;

constexpr size_t kWidth = 23, kHeight = 17, kPixels = kWidth * kHeight;

// The definition, window by window, with variances about the window's mean.
double window_similarity(const RgbaImage& a, const RgbaImage& b, size_t left, size_t top,
                         size_t channel) {
  double sum = 0, mean_a = 0, mean_b = 0;
  const auto over_window = [&](auto add) {
    for (size_t y = 0; y < 11; ++y)
      for (size_t x = 0; x < 11; ++x) {
        const double dx = static_cast<double>(x) - 5, dy = static_cast<double>(y) - 5;
        const size_t place = 4 * ((top + y) * kWidth + left + x) + channel;
        add(std::exp(-(dx * dx + dy * dy) / (2 * 1.5 * 1.5)), double{a[place]}, double{b[place]});
      }
  };
  over_window(
      [&](double w, double va, double vb) { sum += w, mean_a += w * va, mean_b += w * vb; });
  mean_a /= sum, mean_b /= sum;
  double var_a = 0, var_b = 0, covariance = 0;
  over_window([&](double w, double va, double vb) {
    var_a += w / sum * (va - mean_a) * (va - mean_a);
    var_b += w / sum * (vb - mean_b) * (vb - mean_b);
    covariance += w / sum * (va - mean_a) * (vb - mean_b);
  });
  return (2 * mean_a * mean_b + 1e-4) * (2 * covariance + 9e-4) /
         ((mean_a * mean_a + mean_b * mean_b + 1e-4) * (var_a + var_b + 9e-4));
}

TEST(Ssim, IsItsDefinition) {
  const RgbaImage a = random_image(kPixels, 1);
  for (const float share : {0.02f, 0.3f, 1.0f}) {
    const RgbaImage b = mixed(a, random_image(kPixels, 2), share);
    double sum = 0;
    for (size_t top = 0; top + 11 <= kHeight; ++top)
      for (size_t left = 0; left + 11 <= kWidth; ++left)
        for (size_t channel = 0; channel < 3; ++channel)
          sum += window_similarity(a, b, left, top, channel);
    EXPECT_NEAR(ssim(a, b, kWidth), sum / (13 * 7 * 3), 1e-12);
    EXPECT_EQ(ssim(a, b, kWidth), ssim(b, a, kWidth));
  }
}

TEST(Ssim, OfEqualImagesIsOne) {
  const RgbaImage image = random_image(kPixels, 1);
  EXPECT_EQ(ssim(image, image, kWidth), 1);
}

// Without variance only luminance is left; white against black has its constant alone.
TEST(Ssim, OfConstantImagesIsOfTheirLuminance) {
  EXPECT_NEAR(ssim(grey_image(121, 0.25f), grey_image(121, 0.75f), 11),
              (2 * 0.25 * 0.75 + 1e-4) / (0.0625 + 0.5625 + 1e-4), 1e-12);
  EXPECT_NEAR(ssim(grey_image(121, 1), grey_image(121, 0), 11), 1e-4 / (1 + 1e-4), 1e-12);
}

TEST(Ssim, OfAnInvertedImageIsBelowZero) {
  RgbaImage image = random_image(kPixels, 1), inverted = image;
  for (float& value : inverted) value = 1 - value;
  EXPECT_LT(ssim(image, inverted, kWidth), -0.5);
}

TEST(Ssim, FallsAsTheDifferenceGrows) {
  const RgbaImage a = random_image(kPixels, 1), b = random_image(kPixels, 2);
  double last = 1;
  for (const float share : {0.01f, 0.1f, 0.3f, 1.0f}) {
    const double similarity = ssim(mixed(a, b, share), a, kWidth);
    EXPECT_LT(similarity, last);
    last = similarity;
  }
}

TEST(Ssim, SeesEveryChannel) {
  const RgbaImage grey = grey_image(kPixels, 0.5f);
  const double red = ssim(constant_image(kPixels, {0.9f, 0.5f, 0.5f}), grey, kWidth);
  EXPECT_LT(red, 0.96);
  EXPECT_NEAR(ssim(constant_image(kPixels, {0.5f, 0.9f, 0.5f}), grey, kWidth), red, 1e-12);
  EXPECT_NEAR(ssim(constant_image(kPixels, {0.5f, 0.5f, 0.9f}), grey, kWidth), red, 1e-12);
}

TEST(Ssim, IsOfColoursAsAScreenShowsThem) {
  const RgbaImage shown = constant_image(121, {1, 0, 0.25f});
  RgbaImage image = constant_image(121, {1.5f, -3, 0.25f});
  for (size_t i = 3; i < image.size(); i += 4) image[i] = 0;  // alpha
  EXPECT_EQ(ssim(image, shown, 11), 1);
}

TEST(Ssim, OfAPixelThatIsNotFiniteIsThatOfWhiteAgainstBlack) {
  RgbaImage plain = grey_image(kPixels, 0.5f), white = plain, black = plain;
  constexpr size_t middle = kHeight / 2 * kWidth + kWidth / 2;
  set_grey(white, middle, 1);
  set_grey(black, middle, 0);
  const double worst = ssim(white, black, kWidth);
  EXPECT_LT(worst, 0.5);
  for (const float value : {NAN, INFINITY, -INFINITY}) {
    RgbaImage broken = plain;
    broken[4 * middle + 2] = value;
    EXPECT_EQ(ssim(broken, plain, kWidth), worst);
    EXPECT_EQ(ssim(plain, broken, kWidth), worst);
    EXPECT_EQ(ssim(broken, broken, kWidth), worst);
  }
}

TEST(Ssim, RefusesWhatIsSmallerThanItsWindow) {
  const RgbaImage image = grey_image(110, 0.5f);
  for (const size_t width : {size_t{10}, size_t{11}}) try {
      ssim(image, image, width);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::unsupported);
      EXPECT_NE(std::string(error.what()).find(width == 10 ? "10 x 11" : "11 x 10"),
                std::string::npos)
          << error.what();
    }
}

}  // namespace
}  // namespace ssim_test
}  // namespace voyager::tools
