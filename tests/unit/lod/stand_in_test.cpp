// What standing in for several Gaussians costs, against pictures of them integrated by numbers.
#include "runtime/lod/stand_in.h"

#include <array>
#include <cmath>
#include <limits>

#include "tests/support/test_support.h"

namespace voyager::stand_in_test {
namespace {

constexpr double kLowPass = 1.0 / 12;  // pixels², METHOD §12
constexpr double kFootprint = 0.01;    // metres²
constexpr double kPi = 3.14159265358979323846;

Blob blob(const Vec3d& mean, const Vec3d& scale, double opacity) {
  return {mean, {scale.x * scale.x, 0, 0, scale.y * scale.y, 0, scale.z * scale.z}, opacity};
}

// Weighted by opacity times surface, as METHOD §2 has it for Gaussians along the axes.
Blob matched(std::span<const Blob> children) {
  std::vector<double> weights;
  double total = 0;
  for (const Blob& child : children) {
    const double x = std::sqrt(child.covariance[0]), y = std::sqrt(child.covariance[3]),
                 z = std::sqrt(child.covariance[5]);
    weights.push_back(child.opacity * (x * y + x * z + y * z));
    total += weights.back();
  }
  Blob parent{};
  for (size_t i = 0; i < children.size(); ++i)
    parent.mean = parent.mean + weights[i] / total * children[i].mean;
  for (size_t i = 0; i < children.size(); ++i) {
    const Vec3d d = children[i].mean - parent.mean;
    int k = 0;
    for (int a = 0; a < 3; ++a)
      for (int b = a; b < 3; ++b, ++k)
        parent.covariance[k] += weights[i] / total * (children[i].covariance[k] + d[a] * d[b]);
  }
  return parent;
}

// A group of Gaussians of one grey each, a DC coefficient (METHOD §7).
struct Greys {
  std::vector<Blob> children;
  std::vector<float> greys;
  double contrast = 0.4, footprint = kFootprint;

  Group group(double seen = 1) const {
    std::vector<std::array<float, 3>> colours;
    std::array<float, 3> mean{};
    for (const float grey : greys) {
      colours.push_back({grey, grey, grey});
      for (float& m : mean) m += grey / static_cast<float>(greys.size());
    }
    const float* rows[kChildren];
    for (size_t i = 0; i < colours.size(); ++i) rows[i] = colours[i].data();
    Group group;
    group.children = children;
    group.parent = matched(children);
    set_colours({rows, colours.size()}, mean.data(), 1, group);
    std::fill_n(group.seen, colours.size(), seen);
    group.contrast = contrast;
    group.footprint = footprint;
    group.low_pass = kLowPass;
    return group;
  }
};

double pixel_of(const Greys& greys) {
  return stand_in(greys.group()).pixel;
}

const Greys kPair{
    {blob({0, 0, 0}, {0.2, 0.2, 0.2}, 0.8), blob({0.5, 0.1, -0.2}, {0.3, 0.1, 0.2}, 0.5)},
    {0.4f, -0.3f}};
const Greys kFour{
    {blob({0, 0, 0}, {0.2, 0.2, 0.01}, 0.8), blob({0.5, 0, 0}, {0.3, 0.1, 0.01}, 0.5),
     blob({0, 0.6, 0}, {0.1, 0.2, 0.02}, 0.9), blob({0.4, 0.4, 0.05}, {0.2, 0.2, 0.2}, 0.3)},
    {0.4f, -0.3f, 0.1f, 0.2f}};

// A Gaussian's picture along an axis of the scene, at (u, v): with the footprint, and blurred so
// that it keeps its sum.
double picture(const Blob& b, int axis, double pixel, double u, double v) {
  const int across[3][2] = {{1, 2}, {0, 2}, {0, 1}}, at[3][3] = {{3, 4, 5}, {0, 2, 5}, {0, 1, 3}};
  const double blur = kLowPass * pixel * pixel, sharp_uu = b.covariance[at[axis][0]] + kFootprint,
               uv = b.covariance[at[axis][1]], sharp_vv = b.covariance[at[axis][2]] + kFootprint;
  const double uu = sharp_uu + blur, vv = sharp_vv + blur, determinant = uu * vv - uv * uv;
  const double peak = std::sqrt((sharp_uu * sharp_vv - uv * uv) / determinant);
  const double x = u - b.mean[across[axis][0]], y = v - b.mean[across[axis][1]];
  return peak * std::exp(-0.5 * (vv * x * x - 2 * uv * x * y + uu * y * y) / determinant);
}

// f(axis, u, v), summed over the three views.
template <class Integrand>
double integral(double reach, const Integrand& f) {
  constexpr int kSteps = 240;
  const double step = 2 * reach / kSteps;
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j)
        sum += f(axis, (i + 0.5) * step - reach, (j + 0.5) * step - reach);
  return sum * step * step;
}

// Squared difference of what the children and the parent cover.
double coverage_error(const Group& group, double pixel, double opacity) {
  return integral(4 + 4 * pixel, [&](int axis, double u, double v) {
    double lack = -opacity * picture(group.parent, axis, pixel, u, v);
    for (const Blob& child : group.children)
      lack += child.opacity * picture(child, axis, pixel, u, v);
    return lack * lack;
  });
}

// Of colours: each child is drawn in the parent's, the mean. A grey's basis is 1 / √(4π).
double colour_error(const Greys& greys, double pixel) {
  double mean = 0;
  for (const float grey : greys.greys) mean += grey / static_cast<double>(greys.greys.size());
  return integral(4 + 4 * pixel, [&](int axis, double u, double v) {
    double wrong = 0;
    for (size_t i = 0; i < greys.children.size(); ++i)
      wrong += greys.children[i].opacity * (greys.greys[i] - mean) *
               picture(greys.children[i], axis, pixel, u, v);
    return 3 * wrong * wrong / (4 * kPi);
  });
}

TEST(StandIn, IdenticalChildrenInOnePlaceAreReplacedWithoutError) {
  for (const size_t count : {2, 3, 4}) {
    const Greys same{std::vector<Blob>(count, blob({3, -2, 1}, {0.3, 0.1, 0.02}, 0.2)),
                     std::vector<float>(count, 0.25f)};
    const StandIn found = stand_in(same.group());
    EXPECT_LT(found.pixel, 1e-6);
    EXPECT_NEAR(found.opacity, 0.2 * static_cast<double>(count), 1e-9);
  }
}

// Of the pictures with the parent and without, in pixels.
double error_in_pixels(const Greys& greys, const StandIn& found) {
  const double contrast = 3 * (greys.contrast * greys.contrast + 0.1 * 0.1);
  const double error = contrast * coverage_error(greys.group(), found.pixel, found.opacity) +
                       colour_error(greys, found.pixel);
  return std::sqrt(error / 3) / found.pixel;
}

TEST(StandIn, ThePixelIsThatWhosePicturesDifferByOneToleranceForEachThatIsSpared) {
  const double tolerance = error_in_pixels(kPair, stand_in(kPair.group()));
  for (const Greys* greys : {&kPair, &kFour})
    for (const double seen : {1.0, 0.3, 0.1}) {
      const double error = error_in_pixels(*greys, stand_in(greys->group(seen)));
      const double spared = static_cast<double>(greys->children.size() - 1);
      EXPECT_NEAR(error * seen / std::sqrt(spared) / tolerance, 1,
                  0.1);  // found by a few steps
    }
}

TEST(StandIn, OpacityIsThatOfTheLeastErrorOfCoverage) {
  for (const Greys* greys : {&kPair, &kFour}) {
    const Group group = greys->group();
    const StandIn found = stand_in(group);
    const double least = coverage_error(group, found.pixel, found.opacity);
    EXPECT_GT(least, 0);
    for (const double factor : {0.9, 0.99, 1.01, 1.1})
      EXPECT_GT(coverage_error(group, found.pixel, factor * found.opacity), least) << factor;
  }
}

// What is opaque on top of one another covers no more than one of them.
TEST(StandIn, OpacityIsNotFarAboveOne) {
  const Greys pile{std::vector<Blob>(4, blob({0, 0, 0}, {0.2, 0.2, 0.2}, 1)), {0, 0, 0, 0}};
  const StandIn found = stand_in(pile.group());
  const double left = picture(pile.group().parent, 0, found.pixel, 0, 0);
  EXPECT_NEAR(found.opacity * std::sqrt(left), 1.1, 1e-8);
}

// Seen more, a group is wrong up to a larger pixel: there it leaves less of the error.
TEST(StandIn, ErrorFallsAsThePixelGrows) {
  for (const Greys* greys : {&kPair, &kFour}) {
    StandIn before = stand_in(greys->group(0.05));
    for (const double seen : {0.1, 0.2, 0.4, 0.8}) {
      const StandIn found = stand_in(greys->group(seen));
      EXPECT_GT(found.pixel, before.pixel);
      EXPECT_LT(error_in_pixels(*greys, found), error_in_pixels(*greys, before));
      before = found;
    }
  }
}

TEST(StandIn, ColoursThatDifferRaiseTheError) {
  Greys pair = kPair;
  double before = 0;
  for (const float difference : {0.0f, 0.1f, 0.5f, 2.0f}) {
    pair.greys = {difference, -difference};
    const double pixel = pixel_of(pair);
    EXPECT_GT(pixel, before) << difference;
    before = pixel;
  }
}

// Before what looks the same it does not show how much is covered; before another colour it does.
TEST(StandIn, ContrastToWhatIsBehindRaisesTheErrorOfCoverage) {
  Greys pair = kPair;
  pair.greys = {0.2f, 0.2f};
  double before = 0;
  for (const double contrast : {0.0, 0.1, 0.3, 1.0}) {
    pair.contrast = contrast;
    const double pixel = pixel_of(pair);
    EXPECT_GT(pixel, before) << contrast;
    before = pixel;
  }
}

// A colour that is wrong costs as much as is seen of those that have it.
TEST(StandIn, AHiddenChildsColourCostsNothing) {
  Greys pair = kPair;
  pair.greys = {0.2f, 0.2f};
  Group group = pair.group();
  const double alike = stand_in(group).pixel;
  pair.greys = {0.2f, 3.0f};
  const float shown[3] = {0.2f, 0.2f, 0.2f}, hidden[3] = {3, 3, 3};
  const float* rows[2] = {shown, hidden};
  set_colours(rows, shown, 1, group);
  EXPECT_GT(stand_in(group).pixel, 1.1 * alike);
  group.seen[1] = 0;
  EXPECT_NEAR(stand_in(group).pixel, alike, 1e-9);
}

TEST(StandIn, ScalesWithTheScene) {
  Greys larger = kFour;
  for (Blob& b : larger.children) {
    b.mean = 1000.0 * b.mean;
    for (double& c : b.covariance) c *= 1e6;
  }
  larger.footprint *= 1e6;
  const StandIn large = stand_in(larger.group()), small = stand_in(kFour.group());
  EXPECT_NEAR(large.pixel / small.pixel, 1000, 1e-6);
  EXPECT_NEAR(large.opacity, small.opacity, 1e-9);
}

// Two ways to the same numbers: of two, and of any.
TEST(StandIn, ColoursOfTwoAreThoseOfAny) {
  const float a[6] = {0.1f, 0.5f, -0.2f, 0.3f, 0, 1}, b[6] = {-0.7f, 0.25f, 0, 0.1f, 0.5f, 2};
  const double share = 0.25;
  float mean[6];
  for (int k = 0; k < 6; ++k) mean[k] = static_cast<float>(share * a[k] + (1 - share) * b[k]);
  const float* rows[2] = {a, b};
  Group any, two;
  set_colours(rows, mean, 2, any);
  set_colours(share, 1 - share, squared_colour_distance(a, b, 2), two);
  for (int i = 0; i < 2; ++i)
    for (int j = i; j < 2; ++j) EXPECT_NEAR(two.colours[i][j], any.colours[i][j], 1e-7);
}

TEST(StandIn, IsFiniteForEverythingThatATreeMayHold) {
  const float most = std::numeric_limits<float>::max();
  for (const double apart : {0.0, 1e-9, 1.0, 1e18})
    for (const double scale : {0.0, 1e-9, 1e6})
      for (const double opacity : {0.0, 1e-45, 1.0, 1e9})
        for (const float grey : {0.0f, 1.0f, most}) {
          const Greys pair{{blob({0, 0, 0}, {scale, scale, 1e-9}, opacity),
                            blob({apart, 0, 0}, {1e-9, scale, scale}, 0.5)},
                           {grey, -grey}};
          Group group = pair.group();
          const StandIn found = stand_in(group);
          const float extent = static_cast<float>(extent_of(found.pixel));
          ASSERT_TRUE(std::isfinite(extent) && extent >= 0) << extent;
          const float stored = static_cast<float>(found.opacity);
          ASSERT_TRUE(std::isfinite(stored) && stored >= 0) << stored;
        }
}

// The error of colours such as these is beyond binary64 where a pixel is as large as it asks for.
TEST(StandIn, TheLargestColoursAreTheLargestError) {
  const float most = std::numeric_limits<float>::max();
  Greys pair = kPair;
  pair.greys = {1e6f, -1e6f};
  const double before = pixel_of(pair);
  pair.greys = {most, -most};
  EXPECT_GT(pixel_of(pair), before);
  EXPECT_GT(stand_in(pair.group()).opacity, 0);
}

}  // namespace
}  // namespace voyager::stand_in_test
