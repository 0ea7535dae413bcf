#include "runtime/scene/scale_histogram.h"

#include "runtime/scene/sanitise.h"
#include "tests/support/test_support.h"

namespace voyager::scale_histogram_test {
namespace {

// As training leaves them: no smaller across two axes than about a pixel, thin along the third.
GaussianCloud trained(double pixel, size_t count, uint32_t seed) {
  std::mt19937 random(seed);
  std::lognormal_distribution<double> size(1.0, 0.8);
  GaussianCloud cloud;
  for (size_t i = 0; i < count; ++i) {
    const double middle = pixel * size(random), longest = middle * 2, thin = middle * 1e-3;
    for (const double axis : {thin, longest, middle})
      cloud.log_scale.push_back(static_cast<float>(std::log(axis)));
    cloud.opacity.push_back(1.0f);
  }
  return cloud;
}

TEST(ScaleHistogram, EstimatesThePixelWithinAFactorOfTwo) {
  for (const double pixel : {1e-4, 0.01, 0.05, 3.0}) {
    const NativeScale found = estimated_scale(trained(pixel, 20000, 1));
    EXPECT_EQ(found.source, NativeSource::estimated);
    EXPECT_GT(found.pixel, pixel / 2);
    EXPECT_LT(found.pixel, pixel * 2);
    EXPECT_EQ(found.low_pass, kPixelVariance);
  }
}

TEST(ScaleHistogram, LeavesOutWhatIsTooFaintToSee) {
  GaussianCloud cloud = trained(0.05, 2000, 2);
  const NativeScale before = estimated_scale(cloud);
  GaussianCloud faint = trained(1e-6, 2000, 3);
  cloud.log_scale.insert(cloud.log_scale.end(), faint.log_scale.begin(), faint.log_scale.end());
  cloud.opacity.insert(cloud.opacity.end(), 2000, -5.0f);
  EXPECT_EQ(estimated_scale(cloud), before);
}

// A bake in parts adds them as they come.
TEST(ScaleHistogram, IsTheSameInAnyParts) {
  const GaussianCloud first = trained(0.05, 500, 4), second = trained(0.4, 300, 5);
  GaussianCloud both = first;
  both.log_scale.insert(both.log_scale.end(), second.log_scale.begin(), second.log_scale.end());
  both.opacity.insert(both.opacity.end(), second.opacity.begin(), second.opacity.end());
  ScaleHistogram a, b;
  a.add(second);
  b.add(first);
  a.add(b);
  EXPECT_EQ(a.estimate(), estimated_scale(both));
}

// A file holds no larger pixel, and a scene of the largest Gaussians that there are is a scene.
TEST(ScaleHistogram, EstimatesNoPixelThatAFileCannotHold) {
  GaussianCloud cloud = trained(1.0, 100, 6);
  for (float& log : cloud.log_scale) log = kMaxLogScale;
  EXPECT_EQ(estimated_scale(cloud).pixel, kMaxNativePixel);
}

TEST(ScaleHistogram, KnowsNothingOfAnEmptyCloud) {
  EXPECT_EQ(estimated_scale(GaussianCloud()).source, NativeSource::unknown);
}

}  // namespace
}  // namespace voyager::scale_histogram_test
