// A parent has its children's moments; the words it is stored in cost no more
// than the bounds of runtime/lod/validate.h.
#include "runtime/lod/merge.h"

#include <array>

#include "runtime/lod/validate.h"
#include "runtime/scene/sanitise.h"
#include "tests/support/test_support.h"

namespace voyager::merge_test {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

Gaussian leaf(Vec3f mean, Vec3f scale, Quatf rotation, float logit_opacity) {
  return activate(
      {mean, {std::log(scale.x), std::log(scale.y), std::log(scale.z)}, rotation, logit_opacity},
      true);
}

// Written anew from METHOD §1: columns of R times s, then their outer products.
Matrix covariance_of(const Gaussian& g) {
  const long double w0 = g.rotation.w, x0 = g.rotation.x, y0 = g.rotation.y, z0 = g.rotation.z;
  const long double n = std::sqrt(w0 * w0 + x0 * x0 + y0 * y0 + z0 * z0);
  const long double w = w0 / n, x = x0 / n, y = y0 / n, z = z0 / n;
  const long double columns[3][3] = {
      {w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)},
      {2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x)},
      {2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z}};
  Matrix m{};
  for (size_t k = 0; k < 3; ++k)
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 3; ++j) {
        const long double s = g.scale[static_cast<int>(k)];
        m[i][j] += static_cast<double>(columns[k][i] * columns[k][j] * s * s);
      }
  return m;
}

double weight_of(const Gaussian& g) {
  const double x = g.scale.x, y = g.scale.y, z = g.scale.z;
  return double{g.opacity} * (x * y + x * z + y * z);
}

void expect_moments(const std::vector<Gaussian>& children,
                    const std::vector<std::array<float, 12>>& sh, const Gaussian& parent,
                    const float* parent_sh) {
  double total = 0.0;
  std::vector<double> share;
  for (const Gaussian& g : children) total += weight_of(g);
  for (const Gaussian& g : children)
    share.push_back(total > 0 ? weight_of(g) / total : 1.0 / static_cast<double>(children.size()));
  std::array<double, 3> mean{};
  Matrix expected{};
  for (size_t c = 0; c < children.size(); ++c)
    for (size_t i = 0; i < 3; ++i) mean[i] += share[c] * children[c].mean[static_cast<int>(i)];
  for (size_t c = 0; c < children.size(); ++c) {
    const Matrix own = covariance_of(children[c]);
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 3; ++j)
        expected[i][j] +=
            share[c] * (own[i][j] + (children[c].mean[static_cast<int>(i)] - mean[i]) *
                                        (children[c].mean[static_cast<int>(j)] - mean[j]));
  }
  const Matrix found = covariance_of(parent);
  const double trace = expected[0][0] + expected[1][1] + expected[2][2];
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(parent.mean[static_cast<int>(i)], mean[i],
                kMeanTolerance * std::max(std::fabs(mean[i]), std::sqrt(trace)));
    for (size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(found[i][j], expected[i][j], kCovarianceTolerance * trace + 1e-18)
          << i << " " << j;
  }
  EXPECT_NEAR(weight_of(parent), total, kWeightTolerance * total);
  for (size_t k = 0; k < 12; ++k) {
    double value = 0.0, largest = 0.0;
    for (size_t c = 0; c < children.size(); ++c) {
      value += share[c] * double{sh[c][k]};
      largest = std::max(largest, std::fabs(double{sh[c][k]}));
    }
    EXPECT_NEAR(parent_sh[k], value, kShTolerance * largest);
  }
}

GaussianWords merge_and_check(const std::vector<Gaussian>& children, uint32_t seed = 5) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  std::vector<std::array<float, 12>> sh(children.size());
  std::vector<MergeInput> inputs;
  for (size_t c = 0; c < children.size(); ++c) {
    for (float& word : sh[c]) word = uniform(random);
    inputs.push_back({children[c], sh[c].data()});
  }
  std::array<float, 12> merged_sh{};
  const GaussianWords words = merge(inputs, 4, merged_sh.data()).words;
  expect_moments(children, sh, activate(words, false), merged_sh.data());
  return words;
}

TEST(Merge, MomentsOfRandomChildren) {
  const GaussianCloud cloud = test::random_cloud(4000, 3, 0);
  for (size_t i = 0; i + 4 <= cloud.size(); i += 4) {
    std::vector<Gaussian> children;
    for (size_t c = 0; c < 1 + i / 4 % 4; ++c)
      children.push_back(activate(cloud.words(i + c), true));
    merge_and_check(children, static_cast<uint32_t>(i));
  }
}

TEST(Merge, AnyNumberOfChildren) {
  const GaussianCloud cloud = test::random_cloud(1000, 4, 0);
  std::vector<Gaussian> children;
  for (size_t i = 0; i < cloud.size(); ++i) children.push_back(activate(cloud.words(i), true));
  merge_and_check(children);
}

TEST(Merge, OneChildIsItself) {
  const Gaussian child = leaf({1, 2, 3}, {0.5f, 0.1f, 0.02f}, {0.5f, 0.5f, -0.5f, 0.5f}, 1.0f);
  const Gaussian parent = activate(merge_and_check({child}), false);
  EXPECT_NEAR(parent.opacity, child.opacity, 1e-5f);
}

TEST(Merge, NeedlesKeepTheirThinness) {
  // Two needles of ratio 1e7 along one oblique line: the parent is a needle, too.
  const Quatf q = normalise(Quatf{0.3f, 0.5f, -0.2f, 0.7f});
  const Gaussian a = leaf({0, 0, 0}, {10.0f, 1e-6f, 1e-6f}, q, 2.0f);
  const GaussianWords words = merge_and_check({a, a});
  const Vec3f s = activate(words, false).scale;
  EXPECT_NEAR(std::max({s.x, s.y, s.z}), 10.0f, 1e-4f);
  EXPECT_LT(std::min({s.x, s.y, s.z}), 1e-6f);
}

TEST(Merge, DegenerateCovariancesAreRegularised) {
  // All in one point with no extent to speak of, and a disc without thickness.
  const Gaussian speck = leaf({5, 5, 5}, {1e-9f, 1e-9f, 1e-9f}, {1, 0, 0, 0}, 0.0f);
  for (const Gaussian& g : {speck, leaf({0, 0, 0}, {1e6f, 1e6f, 1e-9f}, {1, 0, 0, 0}, 0.0f)}) {
    const GaussianWords words = merge_and_check({g, g, g, g});
    for (int i = 0; i < 3; ++i) {
      EXPECT_TRUE(std::isfinite(words.log_scale[i]));
      EXPECT_GE(std::exp(words.log_scale[i]), 0.999f * static_cast<float>(kMinMergedScale));
    }
  }
}

TEST(Merge, TransparentChildrenWeighTheSame) {
  std::vector<Gaussian> children = {leaf({0, 0, 0}, {1, 1, 1}, {1, 0, 0, 0}, -200.0f),
                                    leaf({4, 0, 0}, {9, 9, 9}, {1, 0, 0, 0}, -200.0f)};
  ASSERT_EQ(children[0].opacity, 0.0f);
  const GaussianWords words = merge_and_check(children);
  EXPECT_EQ(words.opacity, 0.0f);
  EXPECT_EQ(words.mean.x, 2.0f);
}

TEST(Merge, OpacityMayExceedOneAndStaysBounded) {
  const Gaussian one = leaf({0, 0, 0}, {1, 1, 1}, {1, 0, 0, 0}, 88.0f);
  EXPECT_NEAR(merge_and_check({one, one, one, one}).opacity, 4.0f, 1e-4f);
  // Crossed needles: the parent's surface is far larger than theirs; and the
  // bound k² of merge.h holds for every random family.
  std::mt19937 random(9);
  std::uniform_real_distribution<float> uniform(kMinLogScale, 3.0f);
  std::normal_distribution<float> normal;
  for (int repeat = 0; repeat < 2000; ++repeat) {
    std::vector<Gaussian> children;
    for (int c = 0; c < 4; ++c)
      children.push_back(activate({{0, 0, 0},
                                   {uniform(random), uniform(random), uniform(random)},
                                   {normal(random), normal(random), normal(random), normal(random)},
                                   88.0f},
                                  true));
    const float opacity = merge_and_check(children, static_cast<uint32_t>(repeat)).opacity;
    EXPECT_GT(opacity, 0.0f);
    EXPECT_LE(opacity, 16.001f);
  }
}

TEST(Merge, FarApartChildrenStayFinite) {
  const GaussianWords words =
      merge_and_check({leaf({9e17f, 0, 0}, {1, 1, 1}, {1, 0, 0, 0}, 0.0f),
                       leaf({-9e17f, 0, 0}, {1, 1, 1}, {1, 0, 0, 0}, 0.0f)});
  EXPECT_TRUE(std::isfinite(words.opacity));
  EXPECT_NEAR(std::exp(std::max({words.log_scale.x, words.log_scale.y, words.log_scale.z})) / 9e17f,
              1.0f, 1e-4f);
}

TEST(Merge, RotationIsProperAndUnit) {
  const GaussianCloud cloud = test::random_cloud(400, 6, 0);
  std::array<float, 3> sh{};
  for (size_t i = 0; i + 2 <= cloud.size(); i += 2) {
    const std::vector<MergeInput> children = {{activate(cloud.words(i), true), sh.data()},
                                              {activate(cloud.words(i + 1), true), sh.data()}};
    std::array<float, 3> out{};
    const Quatf q = merge(children, 1, out.data()).words.rotation;
    EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1.0f, 1e-6f);
  }
}

}  // namespace
}  // namespace voyager::merge_test
