// Rows of Gaussians that are left out at once: never one of which a Gaussian reaches the image.
#include "runtime/stages/reach.h"

#include <cmath>
#include <limits>

#include "tests/support/test_support.h"

namespace voyager::reach_test {
namespace {

struct Chance {
  std::mt19937 random{7};
  float between(float a, float b) { return std::uniform_real_distribution<float>(a, b)(random); }
  double between(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  }
  // Over several orders of magnitude.
  float size(float least, float most) { return std::exp(between(std::log(least), std::log(most))); }
};

ProjectParams random_camera(Chance& chance) {
  ProjectParams params{};
  const Quatd any{chance.between(-1.0, 1.0), chance.between(-1.0, 1.0), chance.between(-1.0, 1.0),
                  chance.between(-1.0, 1.0)};
  const double width = chance.between(16.0, 2048.0), height = chance.between(16.0, 2048.0);
  const double fx = width * chance.between(0.3, 3.0), fy = height * chance.between(0.3, 3.0);
  params.view =
      view_projection<float>(rotation(normalise(any)), fx, fy, width * chance.between(0.2, 0.8),
                             height * chance.between(0.2, 0.8), width, height);
  params.eye = {chance.between(-100.0, 100.0), chance.between(-100.0, 100.0),
                chance.between(-100.0, 100.0)};
  params.near_z = chance.between(0.01f, 1.0f);
  params.width = static_cast<float>(width), params.height = static_cast<float>(height);
  params.filter = {chance.between(0.01f, 0.3f), chance.size(1e-6f, 1e-2f), true};
  return params;
}

MeanBounds random_bounds(Chance& chance) {
  MeanBounds bounds{};
  for (int i = 0; i < 3; ++i) {
    const float middle = chance.between(-300.0f, 300.0f), half = chance.size(0.01f, 30.0f);
    bounds.least[i] = middle - half, bounds.greatest[i] = middle + half;
  }
  bounds.scale = chance.size(1e-4f, 10.0f);
  bounds.radius = chance.between(0.1f, 5.0f);
  return bounds;
}

Vec3f point_in(const MeanBounds& bounds, Chance& chance) {
  Vec3f point;
  for (int i = 0; i < 3; ++i) point[i] = chance.between(bounds.least[i], bounds.greatest[i]);
  return point;
}

TEST(Reach, ABoxWithAGaussianThatReachesTheImageIsKept) {
  Chance chance;
  int reached = 0, left_out = 0;
  for (int i = 0; i < 20000; ++i) {
    const ProjectParams params = random_camera(chance);
    const MeanBounds bounds = random_bounds(chance);
    const bool kept = may_reach(params, bounds);
    bool reaches = false;
    for (int k = 0; k < 20; ++k)
      reaches = reaches || may_reach(params, point_in(bounds, chance), bounds.scale, bounds.radius);
    ASSERT_TRUE(kept || !reaches) << "box " << i;
    reached += reaches, left_out += !kept;
  }
  // Of the boxes of which no point was seen to reach it, nearly all are left out.
  EXPECT_GT(left_out, (20000 - reached) * 9 / 10);
  EXPECT_GT(reached, 500);
}

TEST(Reach, ABoxOfOnePointIsLeftOutLikeThePoint) {
  Chance chance;
  int apart = 0, outside = 0;
  for (int i = 0; i < 20000; ++i) {
    const ProjectParams params = random_camera(chance);
    MeanBounds bounds = random_bounds(chance);
    bounds.greatest = bounds.least;
    const bool reaches = may_reach(params, bounds.least, bounds.scale, bounds.radius);
    outside += !reaches;
    apart += may_reach(params, bounds) != reaches;
  }
  EXPECT_LT(apart, outside / 20);
}

// Of a Gaussian in the box, with the largest scale and support that it allows.
TEST(Reach, TheBoundsInTheImageHoldEverySplatOfTheBox) {
  Chance chance;
  int bounded = 0;
  for (int i = 0; i < 20000; ++i) {
    const ProjectParams params = random_camera(chance);
    const MeanBounds bounds = random_bounds(chance);
    ImageBounds image;
    if (!image_bounds(params, bounds, image)) continue;
    ++bounded;
    for (int k = 0; k < 20; ++k) {
      const Vec3f mean = point_in(bounds, chance);
      const Vec3f view = detail::to_view(params, camera_relative(mean, params.origin, params.eye));
      const ImageJacobian<float> j = image_jacobian(params.view, view);
      const float variance = bounds.scale * bounds.scale + params.filter.footprint;
      const auto reach = [&](const Vec3f& row) {
        return bounds.radius * std::sqrt(variance * dot(row, row) + params.filter.low_pass);
      };
      const float x = detail::image_x(params, view), y = detail::image_y(params, view);
      ASSERT_LE(image.nearest, view.z) << "box " << i;
      ASSERT_LE(image.left, x - reach(j.x)) << "box " << i;
      ASSERT_GE(image.right, x + reach(j.x)) << "box " << i;
      ASSERT_LE(image.top, y - reach(j.y)) << "box " << i;
      ASSERT_GE(image.bottom, y + reach(j.y)) << "box " << i;
    }
  }
  EXPECT_GT(bounded, 2000);
}

// Not far larger than what they hold, or nothing would be found to be hidden.
TEST(Reach, TheBoundsOfOnePointAreThoseOfItsSplat) {
  Chance chance;
  for (int i = 0; i < 20000; ++i) {
    const ProjectParams params = random_camera(chance);
    MeanBounds bounds = random_bounds(chance);
    bounds.greatest = bounds.least;
    ImageBounds image;
    if (!image_bounds(params, bounds, image)) continue;
    if (!may_reach(params, bounds.least, bounds.scale, bounds.radius)) continue;
    const Vec3f view =
        detail::to_view(params, camera_relative(bounds.least, params.origin, params.eye));
    const float x = detail::image_x(params, view);
    const float largest =
        params.view.fx / view.z *
        std::hypot(1.0f, detail::largest_slope(params.view.x_low, params.view.x_high));
    const float reach =
        bounds.radius * (std::hypot(bounds.scale, std::sqrt(params.filter.footprint)) * largest +
                         std::sqrt(params.filter.low_pass));
    const float slack = 2.0f + 0.02f * reach + 1e-3f * (std::fabs(x) + std::fabs(params.view.cx));
    EXPECT_NEAR(image.nearest, view.z, 1e-5f * (std::fabs(view.z) + 1000.0f));
    EXPECT_GT(image.left, x - reach - slack);
    EXPECT_LT(image.right, x + reach + slack);
  }
}

TEST(Reach, NothingReachesAndWhatOverflowsIsKept) {
  Chance chance;
  const ProjectParams params = random_camera(chance);
  MeanBounds bounds = random_bounds(chance);
  bounds.radius = 0;
  EXPECT_FALSE(may_reach(params, bounds));
  bounds.radius = 3;
  bounds.least = {-1e18f, -1e18f, -1e18f}, bounds.greatest = {1e18f, 1e18f, 1e18f};
  EXPECT_TRUE(may_reach(params, bounds));
  bounds.scale = std::numeric_limits<float>::max();
  EXPECT_TRUE(may_reach(params, bounds));
}

}  // namespace
}  // namespace voyager::reach_test
