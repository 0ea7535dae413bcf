// METHOD §12's native pixel from training cameras.
#include "runtime/scene/native_pixel.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/test_support.h"

namespace voyager::native_pixel_test {
namespace {

// At `position`, with its axes the world's: it looks along z. 90° wide.
TrainingCamera camera_at(const Vec3d& position, double focal = 500) {
  const auto side = static_cast<uint32_t>(2 * focal);
  return {position, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, focal, focal, focal, focal, side, side};
}

void add(GaussianCloud& cloud, const Vec3d& p, float logit = 2) {
  for (int axis = 0; axis < 3; ++axis) cloud.position.push_back(static_cast<float>(p[axis]));
  cloud.opacity.push_back(logit);
}

using Cameras = std::vector<TrainingCamera>;

TEST(NativePixel, IsDepthByFocal) {
  const Cameras one{camera_at({1, 2, 3})};
  EXPECT_DOUBLE_EQ(native_pixel_at({1, 2, 13}, one), 10 / 500.0);
  EXPECT_DOUBLE_EQ(native_pixel_at({6, -2, 13}, one), 10 / 500.0);  // depth, not distance
  Cameras oblong = one;
  oblong[0].fy = 2000;
  EXPECT_DOUBLE_EQ(native_pixel_at({1, 2, 13}, oblong), 10 / 1000.0);
}

TEST(NativePixel, IsTheLeastOverTheCamerasThatSeeThePoint) {
  const Cameras several{camera_at({0, 0, 0}), camera_at({0, 0, 8}), camera_at({0, 0, -90}, 5000)};
  EXPECT_DOUBLE_EQ(native_pixel_at({0, 0, 10}, several), 2 / 500.0);
  EXPECT_DOUBLE_EQ(native_pixel_at({0, 0, 7}, several), 7 / 500.0);      // behind the second
  EXPECT_DOUBLE_EQ(native_pixel_at({0, 0, 30}, several), 120 / 5000.0);  // the third's focal
}

TEST(NativePixel, ACameraThatDoesNotSeeAPointDoesNotCount) {
  const Cameras one{camera_at({0, 0, 0})};
  EXPECT_EQ(native_pixel_at({0, 0, -10}, one), 0);  // behind
  EXPECT_EQ(native_pixel_at({1, 0, 0}, one), 0);    // beside
  EXPECT_GT(native_pixel_at({9.99, -9.99, 10}, one), 0);
  for (const Vec3d& outside : {Vec3d{10.01, 0, 10}, Vec3d{-10.01, 0, 10}, Vec3d{0, 10.01, 10},
                               Vec3d{0, -10.01, 10}, Vec3d{1e18, 0, 10}})
    EXPECT_EQ(native_pixel_at(outside, one), 0);
  EXPECT_EQ(native_pixel_at({0, 0, 10}, {}), 0);

  // Any number of cameras that look elsewhere changes nothing.
  const GaussianCloud cloud = test::random_cloud(500, 7);
  Cameras two{camera_at({0, 0, -30}), camera_at({3, 1, -60})};
  const NativePixel before = native_pixel(two, cloud);
  for (int i = 0; i < 20; ++i) two.push_back(camera_at({i * 0.1, 0, 11}, 5000));
  const NativePixel after = native_pixel(two, cloud);
  EXPECT_EQ(after.seen, before.seen);
  EXPECT_EQ(after.median, before.median);
  EXPECT_EQ(after.ninetieth, before.ninetieth);
}

TEST(NativePixel, OfASceneIsTheMedianOfWhatIsSeen) {
  GaussianCloud cloud;
  cloud.origin = {1024, 0, 0};
  for (int i = 1; i <= 99; ++i) add(cloud, {0, 0, i / 1.0});  // 2 mm to 198 mm
  for (int i = 0; i < 500; ++i) add(cloud, {0, 0, -1.0});     // not seen
  for (int i = 0; i < 500; ++i) add(cloud, {0, 0, 1.0}, -5);  // too faint
  const NativePixel found = native_pixel(Cameras{camera_at({1024, 0, 0})}, cloud);
  EXPECT_EQ(found.looked_at, 599u);
  EXPECT_EQ(found.seen, 99u);
  EXPECT_NEAR(found.tenth, 0.020, 0.020 / 64);
  EXPECT_NEAR(found.median, 0.100, 0.100 / 64);
  EXPECT_NEAR(found.ninetieth, 0.180, 0.180 / 64);
  EXPECT_NEAR(found.second, 0.004, 0.004 / 64);
  EXPECT_NEAR(found.ninety_eighth, 0.196, 0.196 / 64);
  const NativeScale levels{NativeSource::cameras, found.second * std::sqrt(512.0), kPixelVariance,
                           kFootprintLevels};
  EXPECT_EQ(found.scale(), levels);
}

TEST(NativePixel, HasLevelsWhereGaussiansWereSeenAtDifferentSizes) {
  const auto scale = [](double near, double far) {
    GaussianCloud cloud;
    for (int i = 0; i < 50; ++i) add(cloud, {0, 0, near}), add(cloud, {0, 0, far});
    return native_pixel(Cameras{camera_at({0, 0, 0})}, cloud).scale();
  };
  EXPECT_EQ(scale(10, 13.5).levels, 1);
  EXPECT_NEAR(scale(10, 13.5).pixel, 0.020, 0.020 / 64);
  EXPECT_EQ(scale(10, 15).levels, kFootprintLevels);
  EXPECT_NEAR(scale(10, 15).pixel, 0.030, 0.030 / 64);
  // As far as levels reach from the smallest.
  EXPECT_NEAR(scale(1, 1000).pixel, 0.002 * std::sqrt(512.0), 0.002);
}

TEST(NativePixel, ALevelIsTheNearestByFactor) {
  const NativeScale scale{NativeSource::cameras, 0.4, kPixelVariance, kFootprintLevels};
  for (int level = 0; level < kFootprintLevels; ++level) {
    const double pixel = 0.4 * std::pow(2, -0.5 * level);
    EXPECT_NEAR(scale.pixel_of(level), pixel, 1e-15);
    for (const double factor : {0.85, 1.0, 1.18})
      EXPECT_EQ(scale.level_of(factor * pixel), level) << factor;
  }
  EXPECT_EQ(scale.level_of(1e6), 0);
  EXPECT_EQ(scale.level_of(1e-9), kFootprintLevels - 1);
  EXPECT_EQ((NativeScale{NativeSource::given, 0.4, kPixelVariance}).level_of(1e-9), 0);
}

TEST(NativePixel, IsUnknownWhereNothingIsSeen) {
  GaussianCloud cloud;
  EXPECT_EQ(native_pixel(Cameras{camera_at({0, 0, 0})}, cloud).scale(), NativeScale{});
  add(cloud, {0, 0, -1});
  EXPECT_EQ(native_pixel(Cameras{camera_at({0, 0, 0})}, cloud).scale(), NativeScale{});
}

TEST(NativePixel, StaysWithinWhatAFileMayHold) {
  GaussianCloud cloud;
  add(cloud, {0, 0, 9e17});
  EXPECT_LE(native_pixel(Cameras{camera_at({0, 0, 0}, 1)}, cloud).median, kMaxNativePixel);
  GaussianCloud near;
  add(near, {0, 0, 1e-30});
  EXPECT_GT(native_pixel(Cameras{camera_at({0, 0, 0})}, near).median, 0);
}

// Beyond kMost a part of the Gaussians is looked at, which is the same part in every block size.
TEST(NativePixel, OfBlocksInAnyOrderIsThatOfTheScene) {
  GaussianCloud cloud;
  constexpr size_t kCount = 2 * NativePixelHistogram::kMost + 77;
  for (size_t i = 0; i < kCount; ++i)
    add(cloud, {0, 0, 1 + std::fmod(static_cast<double>(i) * 0.6180339887, 1.0) * 99});
  const Cameras cameras{camera_at({0, 0, 0})};
  const NativePixel whole = native_pixel(cameras, cloud);
  EXPECT_LE(whole.looked_at, NativePixelHistogram::kMost);
  EXPECT_GE(whole.looked_at, NativePixelHistogram::kMost / 2);
  EXPECT_NEAR(whole.median, 50.5 / 500, 50.5 / 500 / 50);

  for (const size_t block : {size_t{1} << 12, size_t{1777}}) {
    NativePixelHistogram even(cameras, kCount), odd(cameras, kCount);
    for (size_t n = (kCount - 1) / block + 1; n-- > 0;) {  // the last first
      GaussianCloud part;
      for (size_t i = n * block; i < std::min(kCount, (n + 1) * block); ++i)
        add(part, {0, 0, cloud.position[3 * i + 2]});
      (n % 2 == 0 ? even : odd).add(part, n * block);
    }
    odd.add(even);
    const NativePixel found = odd.find();
    EXPECT_EQ(found.looked_at, whole.looked_at);
    EXPECT_EQ(found.seen, whole.seen);
    EXPECT_EQ(found.tenth, whole.tenth);
    EXPECT_EQ(found.median, whole.median);
    EXPECT_EQ(found.ninetieth, whole.ninetieth);
  }
}

}  // namespace
}  // namespace voyager::native_pixel_test
