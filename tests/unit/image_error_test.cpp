#include "tools/image_error.h"

#include <gtest/gtest.h>

namespace voyager::tools {
namespace {

TEST(ImageError, OfTheSameImagesIsNone) {
  const std::vector<RgbaImage> images = {{0.1f, 0.2f, 0.3f, 1.0f}, {0.5f, 0.6f, 0.7f, 0.0f}};
  const ImageError error = image_error(images, images);
  EXPECT_EQ(error.psnr, INFINITY);
  EXPECT_EQ(error.largest, 0);
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

}  // namespace
}  // namespace voyager::tools
