#include "tools/metrics/popping.h"

#include <gtest/gtest.h>

#include "tests/support/metric_images.h"

namespace voyager::tools {
namespace popping_test {
namespace {

using test::grey_image;
using test::random_image;

constexpr size_t kPixels = 50;

// Values are eighths, so that sums and differences are exact.
std::vector<RgbaImage> path(size_t frames) {
  std::vector<RgbaImage> images;
  for (unsigned i = 0; i < frames; ++i) {
    images.push_back(random_image(kPixels, i));
    for (float& value : images.back()) value = std::floor(value * 5) / 8;  // 0 to 0.5
  }
  return images;
}

Popping popping(const std::vector<RgbaImage>& frames, const std::vector<RgbaImage>& reference) {
  Popping popping;
  for (size_t i = 0; i < frames.size(); ++i) popping.add(frames[i], reference[i]);
  return popping;
}

TEST(Popping, OfTheReferenceItselfIsNone) {
  const std::vector<RgbaImage> reference = path(6);
  const Popping none = popping(reference, reference);
  EXPECT_EQ(none.mean(), 0);
  EXPECT_EQ(none.worst(), 0);
  EXPECT_EQ(none.worst_frame(), 0);
}

TEST(Popping, IsNotError) {
  const std::vector<RgbaImage> reference = path(6);
  std::vector<RgbaImage> brighter = reference;
  for (RgbaImage& image : brighter)
    for (float& value : image) value += 0.25f;
  EXPECT_EQ(popping(brighter, reference).mean(), 0);
  // What moves less than the reference pops no more than it.
  const std::vector<RgbaImage> still(6, reference[0]);
  EXPECT_EQ(popping(still, reference).mean(), 0);
}

TEST(Popping, OfAFrameThatJumpsIsTheJump) {
  const std::vector<RgbaImage> reference(5, grey_image(kPixels, 0.25f));
  std::vector<RgbaImage> frames = reference;
  frames[3] = grey_image(kPixels, 0.5f);  // there and back again: two changes of four
  const Popping jump = popping(frames, reference);
  EXPECT_EQ(jump.worst(), 255 * 0.25);
  EXPECT_EQ(jump.worst_frame(), 3);
  EXPECT_EQ(jump.mean(), 255 * 0.25 / 2);
}

// One channel of one pixel, on top of a change that the reference has too.
TEST(Popping, IsTheMeanOverPixelsAndChannels) {
  const std::vector<RgbaImage> reference = {grey_image(kPixels, 0.25f),
                                            grey_image(kPixels, 0.375f)};
  std::vector<RgbaImage> frames = reference;
  frames[1][4 * 7 + 1] += 0.5f;
  EXPECT_NEAR(popping(frames, reference).mean(), 255 * 0.5 / (3 * kPixels), 1e-12);
  frames[1] = reference[1];
  frames[1][4 * 7 + 3] = 0;  // alpha
  EXPECT_EQ(popping(frames, reference).mean(), 0);
}

TEST(Popping, IsOfColoursAsAScreenShowsThem) {
  const std::vector<RgbaImage> reference(2, grey_image(kPixels, 1));
  EXPECT_EQ(popping({grey_image(kPixels, 1), grey_image(kPixels, 9)}, reference).mean(), 0);
}

TEST(Popping, OfOneFrameOrNoneIsNone) {
  EXPECT_EQ(Popping().mean(), 0);
  EXPECT_EQ(popping(path(1), path(1)).mean(), 0);
}

// In either path, even where it stays so and where both have it.
TEST(Popping, OfAPixelThatIsNotFiniteIsTheWholeRange) {
  const std::vector<RgbaImage> reference(4, grey_image(kPixels, 0.25f));
  for (const float value : {NAN, INFINITY, -INFINITY}) {
    std::vector<RgbaImage> broken = reference;
    for (RgbaImage& image : broken) image[4 * 9] = value;
    for (const Popping& found :
         {popping(broken, reference), popping(reference, broken), popping(broken, broken)}) {
      EXPECT_NEAR(found.mean(), 255.0 / kPixels, 1e-12);
      EXPECT_NEAR(found.worst(), 255.0 / kPixels, 1e-12);
    }
  }
}

}  // namespace
}  // namespace popping_test
}  // namespace voyager::tools
