// What is hidden behind others, and what is not.
#include "runtime/lod/exposure.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/support/test_support.h"

namespace voyager {
namespace {

void add(GaussianCloud& cloud, const Vec3f& mean, float scale, float opacity_word) {
  cloud.position.insert(cloud.position.end(), {mean.x, mean.y, mean.z});
  cloud.log_scale.insert(cloud.log_scale.end(), 3, std::log(scale));
  cloud.rotation.insert(cloud.rotation.end(), {1, 0, 0, 0});
  cloud.opacity.push_back(opacity_word);
  cloud.sh.insert(cloud.sh.end(), 3, 0.0f);
}

constexpr float kOpaque = 8;

// A closed sphere of radius 10 without a gap.
GaussianCloud shell() {
  GaussianCloud cloud;
  cloud.sh_degree = 0;
  constexpr int kCount = 1500;
  for (int i = 0; i < kCount; ++i) {
    const float z = 1 - 2 * (static_cast<float>(i) + 0.5f) / kCount, r = std::sqrt(1 - z * z);
    const float angle = 2.3999632f * static_cast<float>(i);
    add(cloud, {10 * r * std::cos(angle), 10 * r * std::sin(angle), 10 * z}, 0.6f, kOpaque);
  }
  return cloud;
}

std::vector<uint32_t> all_of(const GaussianCloud& cloud) {
  std::vector<uint32_t> leaves(cloud.size());
  std::iota(leaves.begin(), leaves.end(), 0u);
  return leaves;
}

std::vector<uint8_t> exposures(const GaussianCloud& cloud, const std::vector<uint32_t>& leaves) {
  std::vector<uint8_t> exposure(cloud.size());
  find_exposure(cloud, {0, 0, 0}, leaves, exposure);
  return exposure;
}

std::vector<uint8_t> exposures(const GaussianCloud& cloud) {
  return exposures(cloud, all_of(cloud));
}

TEST(Exposure, WhatIsInsideAClosedShellHasTheLeast) {
  GaussianCloud cloud = shell();
  const size_t inside = cloud.size();
  add(cloud, {0, 0, 0}, 0.5f, kOpaque);
  add(cloud, {3, -2, 4}, 0.1f, 0);
  const std::vector<uint8_t> found = exposures(cloud);
  EXPECT_EQ(found[inside], kLeastExposure);
  EXPECT_EQ(found[inside + 1], kLeastExposure);
}

// At most half of all directions see a piece of a convex body from before it.
TEST(Exposure, TheShellItselfIsSeenFromItsOwnSide) {
  for (const uint8_t found : exposures(shell())) {
    ASSERT_GT(found, 3 * kLeastExposure);
    ASSERT_LT(exposure_of(found) * exposure_of(found), 0.6);
  }
}

// Wherever it is: among the few that the pictures leave out, too.
TEST(Exposure, WhatIsOutsideIsSeenFromNearlyEverywhere) {
  for (const float distance : {25.0f, 100.0f, 1e17f}) {
    GaussianCloud cloud = shell();
    add(cloud, {distance, 0, 0}, 0.5f, kOpaque);
    EXPECT_GE(exposures(cloud).back(), 230) << distance;
  }
}

TEST(Exposure, WithoutTheShellTheSameIsSeenFromEverywhere) {
  GaussianCloud cloud;
  cloud.sh_degree = 0;
  add(cloud, {0, 0, 0}, 0.5f, kOpaque);
  EXPECT_EQ(exposures(cloud)[0], 255);
}

TEST(Exposure, WhatIsTooFaintToBeDrawnHasTheLeast) {
  GaussianCloud cloud;
  cloud.sh_degree = 0;
  add(cloud, {0, 0, 0}, 0.5f, -20);
  EXPECT_EQ(exposures(cloud)[0], kLeastExposure);
}

TEST(Exposure, DoesNotDependOnTheOrderOfTheInput) {
  const GaussianCloud cloud = test::random_cloud(800, 5, 0);
  std::vector<uint32_t> leaves = all_of(cloud);
  const std::vector<uint8_t> expected = exposures(cloud, leaves);
  EXPECT_GT(*std::max_element(expected.begin(), expected.end()),
            *std::min_element(expected.begin(), expected.end()) + 50);
  std::mt19937 random(6);
  std::shuffle(leaves.begin(), leaves.end(), random);
  EXPECT_EQ(exposures(cloud, leaves), expected);
}

TEST(Exposure, LooksAtTheGaussiansThatItIsGivenAlone) {
  GaussianCloud cloud = shell();
  const auto inside = static_cast<uint32_t>(cloud.size());
  add(cloud, {0, 0, 0}, 0.5f, kOpaque);
  const std::vector<uint8_t> found = exposures(cloud, {inside});
  EXPECT_EQ(found[inside], 255);
  EXPECT_EQ(std::count(found.begin(), found.end(), 0), static_cast<std::ptrdiff_t>(inside));
}

}  // namespace
}  // namespace voyager
