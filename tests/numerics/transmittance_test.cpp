// METHOD §6: the transmittance of a hundred thousand layers and more, by the CPU's own kernel,
// against float64.
#include <algorithm>
#include <vector>

#include "runtime/cpu/rasterize.h"
#include "tests/numerics/measured.h"
#include "tests/support/test_support.h"

namespace voyager::transmittance_test {
namespace {

using test::kEpsilon;

// Across the one pixel of the image: ρ is 0 there. With siblings, one of so many at t = 0.
Splat sheet(float opacity, uint32_t siblings) {
  Splat s{};
  s.x = s.y = 0.5f;
  s.conic = {1e-30f, 0, 1e-30f};
  s.opacity = opacity;
  s.log_opacity = std::log(opacity);
  s.rho_min = rho_min(s.log_opacity);
  s.colour = {1, 1, 1};
  s.depth = 1;
  s.t = siblings == 1 ? 1.0f : 0.0f;
  s.inverse_k = 1.0f / static_cast<float>(siblings);
  s.half_width = s.half_height = 100;
  return s;
}

struct Column {
  double transmittance = 1, colour = 0;
};

Column kernel(const std::vector<Splat>& splats, size_t layers) {
  std::vector<uint32_t> order(layers);
  for (size_t i = 0; i < layers; ++i) order[i] = static_cast<uint32_t>(i % splats.size());
  cpu::Pixel pixel{};
  const cpu::RasterParams params{splats.data(), nullptr, 0, 1, 1, &pixel, nullptr, {}};
  cpu::pick_rasterizer(Exponential::exact, true, false, false)(params, {0, 0, order});
  return {double{pixel.transmittance}, double{pixel.r}};
}

Column exact(const std::vector<Splat>& splats, size_t layers) {
  Column c;
  for (size_t i = 0; i < layers; ++i) {
    const Splat& s = splats[i % splats.size()];
    const double own = std::min(double{kAlphaMax}, double{s.opacity});
    const double alpha = s.t < 1 ? sibling_alpha(own, double{s.t}, double{s.inverse_k}) : own;
    const double after = c.transmittance * (1 - alpha);
    if (after < double{kTransmittanceEnd}) break;
    c.colour += alpha * c.transmittance;
    c.transmittance = after;
  }
  return c;
}

std::vector<Splat> random_leaves(double most_alpha) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> alpha(double{kAlphaThreshold}, most_alpha);
  std::vector<Splat> splats;
  for (int i = 0; i < 3000; ++i) splats.push_back(sheet(static_cast<float>(alpha(random)), 1));
  return splats;
}

// After how many layers nothing is taken any more.
template <class Blend>
size_t end_of(const Blend& blend, const std::vector<Splat>& splats) {
  const double last = blend(splats, splats.size()).transmittance;
  size_t low = 0, high = splats.size();
  while (low < high) {
    const size_t middle = (low + high) / 2;
    if (blend(splats, middle).transmittance == last)
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

// A leaf's α is at least 1/255, so that T falls to 1e-4 within 2350 layers, each of which
// rounds it by ε at most: a walk of so many steps of either sign. Against α itself that is
// nothing: a pixel ends where float64 ends it, or at a neighbouring layer.
TEST(Transmittance, KeepsItsDigitsToTheEndOfAPixel) {
  for (const double most : {0.0041, 0.02, 0.3, 0.99}) {
    const std::vector<Splat> splats = random_leaves(most);
    const size_t end = end_of(exact, splats), found_end = end_of(kernel, splats);
    EXPECT_LE(std::max(end, found_end) - std::min(end, found_end), 1u) << most;
    double worst = 0, colour = 0;
    for (size_t layers = 1; layers < std::min(end, found_end); layers = layers * 9 / 8 + 1) {
      const Column found = kernel(splats, layers), truth = exact(splats, layers);
      worst = std::max(worst, std::fabs(found.transmittance / truth.transmittance - 1));
      colour = std::max(colour, std::fabs(found.colour - truth.colour));
    }
    EXPECT_LE(worst, kEpsilon * (1 + std::sqrt(static_cast<double>(end)) / 2)) << most;
    EXPECT_LE(colour, kEpsilon * (1 + std::sqrt(static_cast<double>(end)) / 2)) << most;
    const std::string name = "leaves_to_" + std::to_string(most);
    test::record(name + "_layers", static_cast<double>(end));
    test::record(name + "_transmittance_units", worst / kEpsilon);
    test::record(name + "_colour_units", colour / kEpsilon);
  }
}

// k siblings at t = 0 take α'≈ -ln(1 - α)/k each. Below 1, T moves in steps of 2ε: each layer
// rounds it by ε/2, always the same way where T hardly moves, and not at all moves it where
// α' < ε/2. Colour, which grows from 0, keeps its digits.
TEST(Transmittance, OfSiblingsBeyondNumberLosesHalfAnEpsilonEach) {
  struct {
    uint32_t siblings;
    double colour_bound;
  } const cases[] = {{10, 3e-7},    {100, 3e-7},      {1000, 2e-6},
                     {10000, 3e-6}, {100000, 1.3e-5}, {1000000, 1.1e-3}};
  for (const auto& c : cases) {
    double worst = 0, colour = 0;
    for (const double alpha : {0.00393, 0.0077, 0.0294, 0.1, 0.3, 0.5, 0.9, 0.99}) {
      const std::vector<Splat> one = {sheet(static_cast<float>(alpha), c.siblings)};
      const Column found = kernel(one, c.siblings), truth = exact(one, c.siblings);
      worst = std::max(worst, std::fabs(found.transmittance - truth.transmittance));
      colour = std::max(colour, std::fabs(found.colour - truth.colour));
    }
    EXPECT_LE(worst, 3e-7 + 0.5 * kEpsilon * c.siblings) << c.siblings;
    EXPECT_LE(colour, c.colour_bound) << c.siblings;
    const std::string name = "siblings_" + std::to_string(c.siblings);
    test::record(name + "_transmittance", worst);
    test::record(name + "_colour", colour);
  }
}

}  // namespace
}  // namespace voyager::transmittance_test
