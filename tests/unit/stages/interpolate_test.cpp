// METHOD §4: the weight of a node against its parent, and what lies between them.
#include "runtime/stages/interpolate.h"

#include <limits>

#include "runtime/lod/tree_rule.h"
#include "tests/support/test_support.h"

namespace voyager::interpolate_test {
namespace {

TEST(Interpolate, WeightIsOneAtTheOctaveAndZeroAtTheParent) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float share : {kHalfShare, 0.75f, kLateShare}) {
    for (const float parent : {1e-6f, 0.01f, 1.0f, 1e20f})
      for (const float of_parent : {0.0f, 0.1f, 0.5f, 0.7f, 0.99f}) {
        const float size = of_parent * parent, start = std::max(share * parent, size);
        EXPECT_EQ(interpolation_weight(true, parent, size, start, share), 1.0f);
        EXPECT_EQ(interpolation_weight(true, parent, size, parent, share), 0.0f);
        EXPECT_EQ(interpolation_weight(true, parent, size, 0.999f * share * parent, share), 1.0f);
        EXPECT_EQ(interpolation_weight(false, parent, size, parent, share), 1.0f);
      }
    EXPECT_EQ(interpolation_weight(true, kInfinity, 1.0f, 2.0f, share), 1.0f);
    EXPECT_EQ(interpolation_weight(true, kInfinity, kInfinity, kInfinity, share), 1.0f);
    EXPECT_EQ(interpolation_weight(true, kInfinity, 1.0f, 3e38f, share), 1.0f);
    EXPECT_EQ(interpolation_weight(true, 1.0f, 1.0f, 1.0f, share), 1.0f);
  }
}

TEST(Interpolate, WeightFallsAsTheTargetGrowsAndFollowsDouble) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const float parent = 0.01f + uniform(random), size = parent * uniform(random);
    float before = 1;
    for (int k = 0; k <= 100; ++k) {
      const float target = parent * (0.4f + 0.006f * static_cast<float>(k));
      const float t = interpolation_weight(true, parent, size, target, kHalfShare);
      ASSERT_GE(t, 0.0f);
      ASSERT_LE(t, before);
      before = t;
      if (target < 0.501f * parent && target > 0.499f * parent) continue;
      const double start = std::max(0.5 * double{parent}, double{size});
      const double span = double{parent} - start;
      const double truth =
          target <= 0.5f * parent ? 1 : std::clamp(1 - (double{target} - start) / span, 0.0, 1.0);
      ASSERT_NEAR(double{t}, truth, 2e-7 * double{parent} / span);
    }
  }
}

Mat3d covariance(const Vec3d& s, const Quatd& q) {
  const Mat3d r = rotation(q);
  Mat3d c{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) c.row[i][j] += r.row[i][k] * s[k] * s[k] * r.row[j][k];
  return c;
}

struct Pair {  // Gaussian 0 is the parent, 1 its child
  Gaussian gaussians[2];
  float sh[6] = {1, 2, 3, -1, 0, 5};
  uint8_t codes[2] = {0, 0};
  GaussianArrays arrays() const { return {gaussians, sh, codes, 0, false, true}; }
};

Pair random_pair(std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0.1f, 2.0f);
  std::normal_distribution<float> normal;
  Pair pair;
  for (Gaussian& g : pair.gaussians) {
    g = {{normal(random), normal(random), normal(random)},
         uniform(random),
         {uniform(random), uniform(random), uniform(random)},
         0,
         normalise(Quatf{normal(random), normal(random), normal(random), normal(random)})};
    g.log_opacity = std::log(g.opacity);
  }
  return pair;
}

TEST(Interpolate, AtOneTheStoredValuesAreUntouched) {
  std::mt19937 random(2);
  Pair pair = random_pair(random);
  pair.codes[1] = 17;  // not applied to a node that is drawn as itself
  const DrawItem item{1, kNoNode, 1.0f, 1.0f};
  const Shape<float> shape = interpolated_shape<float>(pair.arrays(), item);
  EXPECT_EQ(shape.scale.x, pair.gaussians[1].scale.x);
  EXPECT_EQ(shape.rotation.w, pair.gaussians[1].rotation.w);
  EXPECT_EQ(shape.log_opacity, pair.gaussians[1].log_opacity);
  EXPECT_EQ(interpolated_mean(pair.arrays(), item).x, pair.gaussians[1].mean.x);
}

TEST(Interpolate, NothingLiesBetweenADoubleAndItsChild) {
  const DrawItem only_child{1, 0, 0.37f, 1.0f};
  const DrawItem drawn = drawn_item(only_child, true);
  EXPECT_EQ(drawn.gaussian, 1u);
  EXPECT_EQ(drawn.parent, kNoNode);
  EXPECT_EQ(drawn.t, 1.0f);
  for (const auto& [item, doubles] : {std::pair{only_child, false}, {{1, 0, 0.37f, 0.5f}, true}}) {
    EXPECT_EQ(drawn_item(item, doubles).parent, 0u);
    EXPECT_EQ(drawn_item(item, doubles).t, 0.37f);
  }
}

TEST(Interpolate, AxisCodesLeaveTheChildsCovarianceAlone) {
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    Pair pair = random_pair(random);
    const Shape<double> own = stored_shape<double>(pair.gaussians[1]);
    const Mat3d expected = covariance(own.scale, own.rotation);
    for (int code = 0; code < kAxisCodes; ++code) {
      pair.codes[1] = static_cast<uint8_t>(code);
      const Shape<double> near_one =
          interpolated_shape<double>(pair.arrays(), {1, 0, std::nextafter(1.0f, 0.0f), 0.25f});
      const Mat3d c = covariance(near_one.scale, near_one.rotation);
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          ASSERT_NEAR(c.row[a][b], expected.row[a][b], 1e-5) << "code " << code;
    }
  }
}

TEST(Interpolate, FootprintsGoFromTheParentsToTheChilds) {
  Pair pair;
  pair.codes[0] = node_code(0, 5);
  pair.codes[1] = node_code(17, 2);
  const auto at = [&](float t) {
    return interpolated_footprint(pair.arrays(), {1, 0, t, 0.25f}, 0.64f);
  };
  EXPECT_EQ(at(1), 0.16f);
  EXPECT_EQ(at(0), 0.02f);
  EXPECT_FLOAT_EQ(at(0.25f), 0.75f * 0.02f + 0.25f * 0.16f);
  EXPECT_EQ(interpolated_footprint(pair.arrays(), {0, kNoNode, 1, 1}, 0.64), 0.64 / 32);
}

TEST(Interpolate, WhereAllHaveOneFootprintNoCodeIsRead) {
  Pair pair;
  GaussianArrays arrays = pair.arrays();
  arrays.footprints = false;
  arrays.node_codes = nullptr;
  EXPECT_EQ(interpolated_footprint(arrays, {1, 0, 0.5f, 0.25f}, 0.64f), 0.64f);
}

TEST(Interpolate, AtZeroTheParentIsDrawnAndFloatFollowsDouble) {
  std::mt19937 random(4);
  for (int i = 0; i < 500; ++i) {
    Pair pair = random_pair(random);
    pair.codes[1] = static_cast<uint8_t>(random() % kAxisCodes);
    const Gaussian& parent = pair.gaussians[0];
    const DrawItem start{1, 0, 0.0f, 0.25f};
    const Shape<float> zero = interpolated_shape<float>(pair.arrays(), start);
    const double sign = zero.rotation.w * parent.rotation.w < 0 ? -1 : 1;
    EXPECT_EQ(zero.scale.y, parent.scale.y);
    EXPECT_EQ(zero.opacity, parent.opacity);
    EXPECT_NEAR(double{zero.rotation.x}, sign * double{parent.rotation.x}, 1e-6);
    EXPECT_EQ(interpolated_mean(pair.arrays(), start).z, parent.mean.z);
    EXPECT_EQ(interpolated_colour(pair.arrays(), start, Vec3d{0, 0, 1}).y, 0.5 + kSh0 * 2);

    const DrawItem half{1, 0, 0.37f, 0.25f};
    const Shape<float> f = interpolated_shape<float>(pair.arrays(), half);
    const Shape<double> d = interpolated_shape<double>(pair.arrays(), half);
    const double length = std::sqrt(d.rotation.w * d.rotation.w + d.rotation.x * d.rotation.x +
                                    d.rotation.y * d.rotation.y + d.rotation.z * d.rotation.z);
    EXPECT_NEAR(length, 1, 1e-12);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(double{f.scale[k]}, d.scale[k], 5e-7);
    EXPECT_NEAR(double{f.opacity}, d.opacity, 5e-7);
    EXPECT_NEAR(double{f.log_opacity}, d.log_opacity, 1e-6);
  }
}

}  // namespace
}  // namespace voyager::interpolate_test
