#include "tools/metrics/image_error.h"

#include <gtest/gtest.h>

#include "tests/support/metric_images.h"

namespace voyager::tools {
namespace image_error_test {
namespace {

TEST(ImageError, OfTheSameImagesIsNone) {
  const std::vector<RgbaImage> images = {{0.1f, 0.2f, 0.3f, 1.0f}, {0.5f, 0.6f, 0.7f, 0.0f}};
  const ImageError error = image_error(images, images);
  EXPECT_EQ(error.psnr, INFINITY);
  EXPECT_EQ(error.largest, 0);
  EXPECT_EQ(error.p999, 0);
  EXPECT_EQ(error.not_finite, 0);
}

// Six values, one of them off by a half: mean square 1/24.
TEST(ImageError, IsTakenOverAllImagesTogether) {
  const std::vector<RgbaImage> images = {{0.5f, 0, 0, 1}, {0, 0, 0, 1}};
  const std::vector<RgbaImage> expected = {{0, 0, 0, 1}, {0, 0, 0, 1}};
  const ImageError error = image_error(images, expected);
  EXPECT_NEAR(error.psnr, 10 * std::log10(24.0), 1e-12);
  EXPECT_EQ(error.largest, 0.5);
}

TEST(ImageError, IsOfColoursAsAScreenShowsThem) {
  const ImageError error = image_error({{1.5f, -3.0f, 0.25f, 0.0f}}, {{1.0f, 0.0f, 0.25f, 1.0f}});
  EXPECT_EQ(error.largest, 0);  // beyond [0, 1], and coverage
}

// 3000 values in two images: three may be off, the fourth shows.
TEST(ImageError, OfAThousandthOfTheValuesIsNotInTheirQuantile) {
  const std::vector<RgbaImage> expected(2, test::grey_image(500, 0.25f));
  std::vector<RgbaImage> images = expected;
  images[0][0] = images[0][401] = images[1][1502] = 1;
  EXPECT_EQ(image_error(images, expected).p999, 0);
  EXPECT_EQ(image_error(images, expected).largest, 0.75);
  images[1][4] = 0.375f;
  EXPECT_EQ(image_error(images, expected).p999, 0.125);
}

TEST(ImageError, OfAPixelThatIsNotFiniteIsTheWholeRange) {
  const std::vector<RgbaImage> plain = {test::grey_image(100, 0.5f)};
  for (const float value : {NAN, INFINITY, -INFINITY}) {
    std::vector<RgbaImage> broken = plain;
    broken[0][4 * 31 + 2] = value;
    for (const ImageError& error :
         {image_error(broken, plain), image_error(plain, broken), image_error(broken, broken)}) {
      EXPECT_EQ(error.not_finite, 1);
      EXPECT_EQ(error.largest, 1);
      EXPECT_EQ(error.p999, 1);
      EXPECT_NEAR(error.psnr, 20, 1e-12);  // three values of 300
    }
  }
}

}  // namespace
}  // namespace image_error_test
}  // namespace voyager::tools
