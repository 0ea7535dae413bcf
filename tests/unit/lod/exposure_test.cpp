// What is hidden behind others, and what is not.
#include "runtime/lod/exposure.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/support/test_support.h"

namespace voyager::exposure_test {
namespace {

void add(GaussianCloud& cloud, const Vec3f& mean, float scale, float opacity_word, float grey = 0) {
  cloud.position.insert(cloud.position.end(), {mean.x, mean.y, mean.z});
  cloud.log_scale.insert(cloud.log_scale.end(), 3, std::log(scale));
  cloud.rotation.insert(cloud.rotation.end(), {1, 0, 0, 0});
  cloud.opacity.push_back(opacity_word);
  cloud.sh.insert(cloud.sh.end(), 3, grey);
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

std::vector<ExposureCode> exposures(const GaussianCloud& cloud,
                                    const std::vector<uint32_t>& leaves) {
  std::vector<ExposureCode> exposure(cloud.size());
  find_exposure(cloud, {0, 0, 0}, leaves, exposure);
  return exposure;
}

std::vector<ExposureCode> exposures(const GaussianCloud& cloud) {
  return exposures(cloud, all_of(cloud));
}

TEST(Exposure, WhatIsInsideAClosedShellHasTheLeast) {
  GaussianCloud cloud = shell();
  const size_t inside = cloud.size();
  add(cloud, {0, 0, 0}, 0.5f, kOpaque);
  add(cloud, {3, -2, 4}, 0.1f, 0);
  const std::vector<ExposureCode> found = exposures(cloud);
  EXPECT_EQ(found[inside].seen, kLeastSeen);
  EXPECT_EQ(found[inside + 1].seen, kLeastSeen);
}

// A viewer looks from above, or from the side: a roof counts more than a wall, and that more than
// an underside, which counts more than what nothing shows. Nothing is seen from everywhere.
TEST(Exposure, TheShellItselfIsSeenFromItsOwnSide) {
  const GaussianCloud cloud = shell();
  const std::vector<ExposureCode> found = exposures(cloud);
  const auto mean_of = [&](float least, float greatest) {  // y down
    float sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < cloud.size(); ++i) {
      const float y = cloud.position[3 * i + 1];
      if (y < least || y > greatest) continue;
      sum += exposure_of(found[i]).seen;
      ++count;
    }
    return sum / static_cast<float>(count);
  };
  const float roof = mean_of(-10, -8), wall = mean_of(-2, 2), underside = mean_of(8, 10);
  EXPECT_GT(roof, 1.2f * wall);
  EXPECT_GT(wall, 1.2f * underside);
  EXPECT_GT(underside, 2 * exposure_of({kLeastSeen, 0}).seen);
  for (const ExposureCode of : found) ASSERT_LT(exposure_of(of).seen, 0.6f);
}

// Wherever it is: among the few that the pictures leave out, too.
TEST(Exposure, WhatIsOutsideIsSeenFromNearlyEverywhere) {
  for (const float distance : {25.0f, 100.0f, 1e17f}) {
    GaussianCloud cloud = shell();
    add(cloud, {distance, 0, 0}, 0.5f, kOpaque);
    EXPECT_GE(exposures(cloud).back().seen, 230) << distance;
  }
}

TEST(Exposure, WithoutTheShellTheSameIsSeenFromEverywhere) {
  GaussianCloud cloud;
  cloud.sh_degree = 0;
  add(cloud, {0, 0, 0}, 0.5f, kOpaque);
  EXPECT_EQ(exposures(cloud)[0].seen, 255);
}

TEST(Exposure, WhatIsTooFaintToBeDrawnHasTheLeast) {
  GaussianCloud cloud;
  cloud.sh_degree = 0;
  add(cloud, {0, 0, 0}, 0.5f, -20);
  EXPECT_EQ(exposures(cloud)[0].seen, kLeastSeen);
}

// 8,000 that each cover the whole: in pictures of full size that would take a minute. Coarser ones
// still tell what is before from what is behind.
TEST(Exposure, WhereAllCoverAllPicturesAreCoarser) {
  GaussianCloud fog = test::random_cloud(8000, 7, 0);
  for (size_t i = 0; i < 3 * fog.size(); ++i) fog.position[i] *= 0.01f, fog.log_scale[i] = 1;
  const std::vector<ExposureCode> found = exposures(fog);
  const auto [least, most] = std::minmax_element(
      found.begin(), found.end(), [](ExposureCode a, ExposureCode b) { return a.seen < b.seen; });
  EXPECT_EQ(least->seen, kLeastSeen);
  EXPECT_GT(most->seen, 3 * kLeastSeen);
}

TEST(Exposure, DoesNotDependOnTheOrderOfTheInput) {
  const GaussianCloud cloud = test::random_cloud(800, 5, 0);
  std::vector<uint32_t> leaves = all_of(cloud);
  const std::vector<ExposureCode> expected = exposures(cloud, leaves);
  const auto [least, most] =
      std::minmax_element(expected.begin(), expected.end(),
                          [](ExposureCode a, ExposureCode b) { return a.seen < b.seen; });
  EXPECT_GT(most->seen, least->seen + 50);
  std::mt19937 random(6);
  std::shuffle(leaves.begin(), leaves.end(), random);
  EXPECT_EQ(exposures(cloud, leaves), expected);
}

TEST(Exposure, LooksAtTheGaussiansThatItIsGivenAlone) {
  GaussianCloud cloud = shell();
  const auto inside = static_cast<uint32_t>(cloud.size());
  add(cloud, {0, 0, 0}, 0.5f, kOpaque);
  const std::vector<ExposureCode> found = exposures(cloud, {inside});
  EXPECT_EQ(found[inside].seen, 255);
  EXPECT_EQ(std::count(found.begin(), found.end(), ExposureCode{0, 0}),
            static_cast<std::ptrdiff_t>(inside));
}

// A spot on a wall, which is seen from both sides: once before the wall, once the wall before it.
TEST(Exposure, ContrastIsToWhatShowsWithoutAGaussian) {
  const auto contrast = [](float wall, float spot) {
    GaussianCloud cloud;
    cloud.sh_degree = 0;
    for (int i = 0; i < 900; ++i)
      add(cloud, {static_cast<float>(i % 30), static_cast<float>(i / 30), 0}, 0.8f, kOpaque, wall);
    add(cloud, {15, 15, 3}, 0.5f, kOpaque, spot);
    return exposure_of(exposures(cloud).back()).contrast;
  };
  constexpr float kBlack = -1.7725f, kWhite = 1.7725f;  // 0.5 / 0.2821
  EXPECT_LT(contrast(kWhite, kWhite), 0.02f);
  EXPECT_LT(contrast(kBlack, kBlack), 0.02f);
  EXPECT_GT(contrast(kBlack, kWhite), 0.8f);
  EXPECT_GT(contrast(kWhite, kBlack), 0.8f);
  const float half = contrast(kBlack, 0);
  EXPECT_GT(half, 0.4f);
  EXPECT_LT(half, 0.55f);
}

// Among the few that the pictures leave out nothing is known of what is behind.
TEST(Exposure, BeyondThePictureContrastIsTakenToBeModerate) {
  GaussianCloud cloud = shell();
  add(cloud, {1e17f, 0, 0}, 0.5f, kOpaque);
  EXPECT_NEAR(exposure_of(exposures(cloud).back()).contrast, 0.2f, 0.01f);
}

TEST(Exposure, TheMeanIsWeightedByWhatIsSeen) {
  const Exposure of[2] = {{1, 0.1f, 1}, {0.1f, 1, 1}};
  const double equal[2] = {1, 1}, none[2] = {0, 0}, first[2] = {5, 0};
  for (const double* weights : {equal, none}) {
    const Exposure mean = mean_exposure(of, {weights, 2});
    EXPECT_FLOAT_EQ(mean.seen, 0.55f);
    EXPECT_FLOAT_EQ(mean.contrast, std::sqrt((0.01f + 0.01f) / 1.01f));
  }
  EXPECT_FLOAT_EQ(mean_exposure(of, first).contrast, 0.1f);
}

}  // namespace
}  // namespace voyager::exposure_test
