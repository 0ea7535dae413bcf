// FLIP against numbers that others published; each says where it stands. The mean that the
// authors' own tests expect (0.159691, NVlabs/flip, tests/test.py) is of photographs, and these
// are not here.
#include <gtest/gtest.h>

#include "tests/support/metric_images.h"
#include "tools/metrics/flip.h"
#include "tools/metrics/flip_colour.h"
#include "tools/metrics/flip_filters.h"

namespace voyager::tools {
namespace flip_published_test {
namespace {

using test::code_value;
using test::grey_image;

// NVlabs/flip, README: 67 pixels per degree; CyberAgent's FlipBinding.CSharp, Flip.cs, has
// more digits of it.
TEST(FlipPublished, PixelsPerDegree) {
  EXPECT_NEAR(kFlipPixelsPerDegree, 67.0206451, 5e-6);
}

// jeremyong/flop, shaders/ColorCompare.hlsl.
TEST(FlipPublished, LargestColourDistance) {
  EXPECT_NEAR(largest_colour_distance(), 41.2760963, 5e-6);
}

// Weights at 0, 1, 2, … pixels from the middle; `scale` undoes another normalisation.
void expect_weights(const Kernel& kernel, const std::vector<double>& published, double scale = 1,
                    double tolerance = 1e-8) {
  ASSERT_GE(kernel.size(), 2 * published.size() - 1);
  for (size_t i = 0; i < published.size(); ++i)
    EXPECT_NEAR(scale * kernel[kernel.size() / 2 + i], published[i], tolerance) << i;
}

// jeremyong/flop, shaders/FeatureFilter.hlsl, of shaders/flip_kernels.js: 67 pixels per degree.
TEST(FlipPublished, FeatureFilters) {
  const FlipFilters filters = flip_filters(67);
  expect_weights(filters.smooth, {0.14530192, 0.13598623, 0.11147196, 0.08003564, 0.05033249,
                                  0.02772429, 0.01337580, 0.00565231, 0.00209209, 0.00067823});
  expect_weights(filters.edge, {0.00000000, -0.12572107, -0.20611460, -0.22198204, -0.18613221,
                                -0.12815738, -0.07419661, -0.03657945, -0.01547329, -0.00564333});
  expect_weights(filters.point, {-0.29897641, -0.24272794, -0.10778385, 0.03217138, 0.11763449,
                                 0.13377647, 0.10521736, 0.06477641, 0.03265116, 0.01377273});
}

// jeremyong/flop, shaders/CSFFilter.hlsl, of the same script: 66 pixels per degree. Its first two
// end after four pixels, which drops less than 2e-5 of the weights. Its Gaussians of blue-yellow
// sum to the root of their share.
TEST(FlipPublished, SensitivityFilters) {
  const FlipFilters filters = flip_filters(66);
  expect_weights(filters.light, {0.39172750, 0.24189219, 0.05695543, 0.00511357, 0.00017506}, 1,
                 2e-5);
  expect_weights(filters.red_green, {0.36889303, 0.24056897, 0.06672016, 0.00786960, 0.00039475}, 1,
                 2e-5);
  const double share = filters.blue_yellow_share;
  expect_weights(filters.blue_yellow[0],
                 {0.11730367, 0.11084383, 0.09352148, 0.07045487, 0.04739261, 0.02846493,
                  0.01526544, 0.00730985, 0.00312541, 0.00119318},
                 std::sqrt(share));
  expect_weights(filters.blue_yellow[1],
                 {0.08301017, 0.07581780, 0.05776847, 0.03671896, 0.01947017, 0.00861249,
                  0.00317810, 0.00097833, 0.00025124, 0.00005382},
                 std::sqrt(1 - share));
}

// Linear 0.1 and 0.9 in binary16.
constexpr double kDark = 0.099975586, kLight = 0.89990234;
constexpr size_t kPixels = 64 * 64;

// AcademySoftwareFoundation/OpenImageIO, testsuite/flip: run.py, ref/out.txt.
TEST(FlipPublished, DarkAgainstLight) {
  const RgbaImage dark = grey_image(kPixels, code_value(kDark));
  const Flip difference = flip(grey_image(kPixels, code_value(kLight)), dark, 64);
  EXPECT_NEAR(difference.mean, 0.9514, 5e-5);
  EXPECT_NEAR(*std::max_element(difference.map.begin(), difference.map.end()), 0.9514, 5e-5);
  EXPECT_EQ(flip(dark, dark, 64).mean, 0);
}

// The same test with HDR-FLIP, which is LDR-FLIP of tone-mapped images: its exposure is such that
// the reference's brightest has 0.85 after Narkowicz's fit of ACES. Theirs is in binary32, where
// filters find features of 1e-8 to 1e-7 in a constant image; the square root makes 3e-4 of those.
TEST(FlipPublished, DarkAgainstLightToneMapped) {
  const auto tone_mapped = [](double x) {
    return (0.36 * 2.51 * x * x + 0.6 * 0.03 * x) / (0.36 * 2.43 * x * x + 0.6 * 0.59 * x + 0.14);
  };
  double exposure = 1;  // from the positive root of tone_mapped(x) = 0.85
  for (double step = 32; step > 1e-12; step /= 2)
    if (tone_mapped((exposure + step) * kDark) < 0.85) exposure += step;
  EXPECT_NEAR(std::log2(exposure), 4.41, 5e-3);
  const RgbaImage dark = grey_image(kPixels, code_value(tone_mapped(exposure * kDark)));
  const RgbaImage light = grey_image(kPixels, code_value(tone_mapped(exposure * kLight)));
  EXPECT_NEAR(flip(light, dark, 64).mean, 0.2045, 1e-4);
}

}  // namespace
}  // namespace flip_published_test
}  // namespace voyager::tools
