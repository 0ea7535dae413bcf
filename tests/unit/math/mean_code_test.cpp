#include "runtime/math/mean_code.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>
#include <vector>

namespace voyager::mean_code_test {
namespace {

struct Cloud {
  std::vector<Vec3f> means;
  Vec3f least{}, greatest{};

  MeanGrid grid() const { return mean_grid(least, greatest); }
};

void find_ends(Cloud& cloud) {
  cloud.least = cloud.greatest = cloud.means.front();
  for (const Vec3f& mean : cloud.means)
    for (int axis = 0; axis < 3; ++axis) {
      cloud.least[axis] = std::min(cloud.least[axis], mean[axis]);
      cloud.greatest[axis] = std::max(cloud.greatest[axis], mean[axis]);
    }
}

Cloud random_cloud(uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(-1, 1);
  // Sizes and distances from far below a micrometre to the most that a scene may have.
  const double extent = std::pow(10.0, 12 * share(random)),
               away = std::pow(10.0, 17 * share(random));
  Cloud cloud;
  for (int i = 0; i < 107; ++i) {
    Vec3f mean{};
    for (int axis = 0; axis < 3; ++axis)
      mean[axis] = static_cast<float>((axis == 1 ? 0 : away) + extent * share(random));
    cloud.means.push_back(mean);
  }
  find_ends(cloud);
  return cloud;
}

Cloud restored(const Cloud& cloud) {
  const MeanGrid grid = cloud.grid();
  Cloud out;
  for (const Vec3f& mean : cloud.means)
    out.means.push_back(restored_mean(mean_code(mean, grid), grid));
  find_ends(out);
  return out;
}

bool same_bits(const Vec3f& a, const Vec3f& b) {
  return std::bit_cast<std::array<uint32_t, 3>>(a) == std::bit_cast<std::array<uint32_t, 3>>(b);
}

TEST(MeanCode, AMeanIsOffByHalfAStepAtMost) {
  for (uint32_t seed = 0; seed < 400; ++seed) {
    const Cloud cloud = random_cloud(seed), out = restored(cloud);
    const double half = 0.5 * cloud.grid().step;
    for (size_t i = 0; i < cloud.means.size(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        ASSERT_LE(std::fabs(double{out.means[i][axis]} - cloud.means[i][axis]), half) << seed;
  }
}

// What a step costs: the chunk's longest side in 2^21 parts, or what binary32 has at its place.
TEST(MeanCode, AStepIsNoLongerThanItMustBe) {
  for (uint32_t seed = 0; seed < 400; ++seed) {
    const Cloud cloud = random_cloud(seed);
    double farthest = 0, longest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      farthest = std::max({farthest, std::fabs(double{cloud.least[axis]}),
                           std::fabs(double{cloud.greatest[axis]})});
      longest = std::max(longest, double{cloud.greatest[axis]} - cloud.least[axis]);
    }
    const double finest = std::max({farthest * 0x1p-24, longest / kMostMeanSteps, 0x1p-126});
    EXPECT_LE(cloud.grid().step, 4 * finest) << seed;
  }
}

// A file that was read and is baked again must not drift.
TEST(MeanCode, RestoredMeansComeBackToTheBit) {
  for (uint32_t seed = 0; seed < 400; ++seed) {
    const Cloud once = restored(random_cloud(seed)), twice = restored(once);
    for (size_t i = 0; i < once.means.size(); ++i)
      ASSERT_TRUE(same_bits(once.means[i], twice.means[i])) << seed << " " << i;
  }
}

TEST(MeanCode, EndsOfTheRange) {
  const float most = 9.9e17f, least = std::numeric_limits<float>::denorm_min();
  const std::vector<std::vector<Vec3f>> clouds = {
      {{0, 0, 0}},
      {{-0.0f, 0, -0.0f}},
      {{1, 2, 3}},
      {{-most, -most, -most}, {most, most, most}},
      {{most, 0, 0}},
      {{-least, least, 0}},
      {{0x1.fffffep9f, 0, 0}},
      {{-0x1.fffffep20f, 0, 0}, {0x1.fffffep0f, 0x1p-20f, 0}}};
  for (const std::vector<Vec3f>& means : clouds) {
    Cloud cloud{means};
    find_ends(cloud);
    const Cloud out = restored(cloud);
    for (size_t i = 0; i < means.size(); ++i)
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(std::fabs(double{out.means[i][axis]} - means[i][axis]), 0.5 * cloud.grid().step);
        EXPECT_FALSE(std::signbit(out.means[i][axis]) && out.means[i][axis] == 0);
      }
  }
}

}  // namespace
}  // namespace voyager::mean_code_test
