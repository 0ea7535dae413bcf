// 300 frames of a walk through the loaded plugin, unloaded, and all of it again.
#include <cmath>
#include <string>
#include <vector>

#include "host.h"

namespace walk_test {
namespace {

// The sum of all coverage; fails for a value that is no number.
double coverage(const Host& host) {
  double sum = 0;
  for (size_t i = 0; i < host.pixels.size(); ++i) {
    EXPECT_TRUE(std::isfinite(host.pixels[i])) << "component " << i;
    if (i % 4 == 3) sum += static_cast<double>(host.pixels[i]);
  }
  for (const float depth : host.depth) EXPECT_TRUE(depth > 0.2f) << depth;
  return sum;
}

// A checksum of the walk's images.
size_t walk() {
  const Library voy;
  Host host(voy, VOY_DEVICE_DESC_INIT, 3000);
  size_t sum = 0;
  for (int i = 0; i < 300; ++i) {
    const double x = -10 + 20 * i / 299.0, yaw = 0.5 * std::sin(0.05 * i);
    EXPECT_EQ(host.render(x, yaw), VOY_SUCCESS) << voy.message();
    EXPECT_GT(coverage(host), 100) << "frame " << i << " is all but empty";
    const std::string_view image(reinterpret_cast<const char*>(host.pixels.data()),
                                 host.pixels.size() * sizeof(float));
    sum = sum * 31 + std::hash<std::string_view>()(image);
  }
  VoyFrameStats stats = VOY_FRAME_STATS_INIT;
  EXPECT_EQ(voy.GetFrameStats(host.view, &stats), VOY_SUCCESS);
  EXPECT_EQ(stats.frameIndex, 299u);
  EXPECT_GT(stats.splats, 0u);
  for (uint32_t i = 0; i < VOY_MAX_STAGES; ++i) {
    EXPECT_EQ(voy.StageName(static_cast<VoyStage>(i)) != nullptr, i < stats.stageCount) << i;
    EXPECT_TRUE(i < stats.stageCount || stats.milliseconds[i] == 0) << i;
  }
  return sum;
}

TEST(Walk, LoadsRunsUnloadsAndRepeatsToTheBit) {
  ASSERT_FALSE(Library::is_mapped());
  const size_t first = walk();
  EXPECT_FALSE(Library::is_mapped()) << "dlclose left the library in the process";
  EXPECT_EQ(walk(), first);
  EXPECT_FALSE(Library::is_mapped());
}

TEST(Walk, SameFrameTwiceIsTheSameImage) {
  const Library voy;
  Host host(voy, VOY_DEVICE_DESC_INIT, 3000);
  ASSERT_EQ(host.render(1, 0.1), VOY_SUCCESS);
  const std::vector<float> pixels = host.pixels, depth = host.depth;
  ASSERT_EQ(host.render(-4, 0.3), VOY_SUCCESS);
  EXPECT_NE(host.pixels, pixels);
  ASSERT_EQ(host.render(1, 0.1), VOY_SUCCESS);
  EXPECT_EQ(host.pixels, pixels);
  EXPECT_EQ(host.depth, depth);
}

TEST(Walk, ImagesDoNotDependOnTheNumberOfThreads) {
  const Library voy;
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.workerThreadCount = 1;
  Host one(voy, desc, 3000);
  desc.workerThreadCount = 5;
  Host five(voy, desc, 3000);
  ASSERT_EQ(one.render(), VOY_SUCCESS);
  ASSERT_EQ(five.render(), VOY_SUCCESS);
  EXPECT_EQ(one.pixels, five.pixels);
  EXPECT_EQ(one.depth, five.depth);
}

TEST(Walk, FrustumAndOrientationFollowOpenXr) {
  const Library voy;
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  Host host(voy, desc, 3000);
  // The slab's right end is at x = 20: looking at it from 12 m before x = 20, the
  // left half of the image is scene and the right half is not.
  VoyFrameEye eye = host.eye(20);
  ASSERT_EQ(host.render(eye), VOY_SUCCESS);
  const auto half = [&](bool right) {
    double sum = 0;
    for (uint32_t i = 0; i < Host::kWidth * Host::kHeight; ++i)
      if ((i % Host::kWidth >= Host::kWidth / 2) == right)
        sum += static_cast<double>(host.pixels[4 * i + 3]);
    return sum;
  };
  EXPECT_GT(half(false), 4 * half(true));
  // From behind, it is the other way round.
  eye.pose.position[2] = -12;
  eye.pose.orientation[1] = 1;
  eye.pose.orientation[3] = 0;
  ASSERT_EQ(host.render(eye), VOY_SUCCESS);
  EXPECT_GT(half(true), 4 * half(false));
}

}  // namespace
}  // namespace walk_test
