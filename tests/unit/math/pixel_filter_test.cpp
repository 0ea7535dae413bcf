// METHOD §12: what the pixel filter widens it also thins, whatever the Gaussian is.
#include "runtime/math/pixel_filter.h"

#include "runtime/math/projection.h"
#include "tests/support/test_support.h"

namespace voyager::pixel_filter_test {
namespace {

ViewProjection<float> camera() {
  return view_projection<float>({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 500, 500, 320, 240, 640, 480);
}

ImageCovariance<float> covariance(const Vec3f& scale, float z, float low_pass,
                                  const Quatf& q = {1, 0, 0, 0}) {
  return image_covariance(image_jacobian(camera(), Vec3f{0, 0, z}), q, scale, low_pass);
}

// Σ' and the share of the peak: what is kept of the sum over all pixels.
double sum_of(const ImageCovariance<float>& c) {
  return std::sqrt(double{c.xx} * double{c.y_given_x} * double{c.kept});
}

TEST(PixelFilter, KeepsTheSumOfASplat) {
  constexpr auto low = static_cast<float>(kPixelVariance);
  for (const float z : {1.0f, 10.0f, 100.0f, 1e4f}) {
    const double pixels = 500.0 / double{z} * 0.05;  // of 5 cm
    const ImageCovariance<float> c = covariance({0.05f, 0.05f, 0.05f}, z, low);
    EXPECT_NEAR(sum_of(c), pixels * pixels, 1e-5 * pixels * pixels) << z;
  }
}

TEST(PixelFilter, KeepsBetweenNothingAndAll) {
  constexpr auto low = static_cast<float>(kPixelVariance);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> exponent(-9, 6);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f scale{std::pow(10.0f, exponent(random)), std::pow(10.0f, exponent(random)),
                      std::pow(10.0f, exponent(random))};
    const Quatf q =
        normalise(Quatf{normal(random), normal(random), normal(random), normal(random) + 1e-3f});
    const ImageCovariance<float> c = covariance(scale, std::pow(10.0f, exponent(random)), low, q);
    if (!(c.xx < 1e36f && c.yy < 1e36f)) continue;  // projection drops what is that large
    ASSERT_GE(c.kept, 0.0f);
    ASSERT_LE(c.kept, 1.0f + 1e-6f);
  }
}

// A disc from its side has no area before the filter, and so keeps nothing.
TEST(PixelFilter, OfADiscSeenFromItsSideNothingIsLeft) {
  const ImageCovariance<float> c = covariance({1, 0, 1}, 10, static_cast<float>(kPixelVariance));
  EXPECT_EQ(c.kept, 0.0f);
  EXPECT_GT(c.y_given_x, 0.0f);
}

TEST(PixelFilter, IsNothingWhereGaussiansAreLarge) {
  const ImageCovariance<float> c = covariance({10, 10, 10}, 10, 0.1f);
  EXPECT_NEAR(c.kept, 1.0f, 1e-5f);
}

TEST(PixelFilter, AFootprintIsAddedToTheVarianceOfEachAxis) {
  const Vec3d wide = widened(Vec3d{3, 0, 1e-9}, 16.0);
  EXPECT_EQ(wide.x, 5.0);
  EXPECT_EQ(wide.y, 4.0);
  EXPECT_EQ(wide.z, 4.0);
  EXPECT_NEAR(native_footprint(0.05), (0.3 - 1.0 / 12) * 0.0025, 1e-18);
  EXPECT_EQ(native_footprint(0), 0.0);
}

}  // namespace
}  // namespace voyager::pixel_filter_test
