#include "tools/metrics/shimmer.h"

#include <gtest/gtest.h>

#include "tests/support/metric_images.h"

namespace voyager::tools {
namespace shimmer_test {
namespace {

using test::grey_image;
using Images = std::vector<RgbaImage>;

constexpr size_t kPixels = 50;

TEST(Shimmer, IsHowMuchMoreThePictureChangesThanTheReference) {
  const Images reference = {grey_image(kPixels, 0.5f), grey_image(kPixels, 0.625f),
                            grey_image(kPixels, 0.5f)};
  EXPECT_EQ(shimmer(reference, reference), 1);
  const Images twice = {grey_image(kPixels, 0.25f), grey_image(kPixels, 0.5f),
                        grey_image(kPixels, 0.25f)};
  EXPECT_EQ(shimmer(twice, reference), 2);
  const Images still(3, reference[0]);
  EXPECT_EQ(shimmer(still, reference), 0);
}

// A change that the reference has elsewhere is none that it has here: both count.
TEST(Shimmer, CountsChangesNotErrors) {
  Images reference(2, grey_image(kPixels, 0.5f)), brighter(2, grey_image(kPixels, 0.75f));
  test::set_grey(reference[1], 3, 0.625f);
  test::set_grey(brighter[1], 7, 0.875f);
  EXPECT_EQ(shimmer(brighter, reference), 1);
}

TEST(Shimmer, IsOfAScreenAndOfColours) {
  const Images reference = {grey_image(kPixels, 0.5f), grey_image(kPixels, 1)};
  const Images beyond = {grey_image(kPixels, 0.5f), grey_image(kPixels, 7)};
  EXPECT_EQ(shimmer(beyond, reference), 1);
  Images opaque = reference;
  for (size_t i = 3; i < opaque[1].size(); i += 4) opaque[1][i] = 0;
  EXPECT_EQ(shimmer(opaque, reference), 1);
}

TEST(Shimmer, IsUnknownWhereNothingChangesOrAPixelIsNotFinite) {
  const Images still(2, grey_image(kPixels, 0.5f));
  EXPECT_FALSE(shimmer(still, still));
  EXPECT_FALSE(shimmer({}, {}));
  Images reference = still, broken = still;
  test::set_grey(reference[1], 0, 0.625f);
  test::set_grey(broken[1], 0, NAN);
  EXPECT_FALSE(shimmer(broken, reference));
  EXPECT_FALSE(shimmer(reference, broken));
}

}  // namespace
}  // namespace shimmer_test
}  // namespace voyager::tools
