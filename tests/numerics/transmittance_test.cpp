// METHOD §6: the transmittance of a hundred thousand layers and more, by the CPU's own kernel,
// against float64.
#include <numeric>
#include <vector>

#include "runtime/cpu/rasterize.h"
#include "tests/numerics/measured.h"
#include "tests/support/test_support.h"

namespace voyager {
namespace {

using test::kEpsilon;

// A sheet across the tile: ρ is 0 at every pixel.
Splat sheet(float opacity, uint32_t siblings) {
  Splat s{};
  s.x = s.y = 8;
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
  std::vector<cpu::Pixel> pixels(size_t{kTile} * kTile);
  const cpu::RasterParams params{splats.data(), nullptr,       0,       kTile,
                                 kTile,         pixels.data(), nullptr, {}};
  cpu::pick_rasterizer(Exponential::exact, true, false, false)(params, {0, 0, order});
  return {double{pixels[0].transmittance}, double{pixels[0].r}};
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

TEST(Transmittance, TwoThousandLayersEndAPixelWithTheirDigits) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const double most : {0.0041, 0.02, 0.3, 0.99}) {
    std::vector<Splat> splats;
    for (int i = 0; i < 3000; ++i)
      splats.push_back(sheet(
          static_cast<float>(kAlphaThreshold + (most - kAlphaThreshold) * uniform(random)), 1));
    double worst = 0, colour = 0;
    for (size_t layers = 1; layers < 3000; layers = layers * 5 / 4 + 1) {
      const Column a = kernel(splats, layers), b = exact(splats, layers);
      worst = std::max(worst, std::fabs(a.transmittance / b.transmittance - 1));
      colour = std::max(colour, std::fabs(a.colour - b.colour));
    }
    test::record("leaves_" + std::to_string(most) + "_relative", worst / kEpsilon);
    test::record("leaves_" + std::to_string(most) + "_colour", colour / kEpsilon);
  }
}

TEST(Transmittance, SiblingsBeyondNumber) {
  for (const uint32_t k : {10u, 100u, 1000u, 10000u, 100000u, 1000000u}) {
    double worst = 0, colour = 0, at = 0;
    for (const double alpha : {0.00393, 0.0077, 0.03, 0.1, 0.3, 0.5, 0.9, 0.99}) {
      const std::vector<Splat> one = {sheet(static_cast<float>(alpha), k)};
      const Column a = kernel(one, k), b = exact(one, k);
      const double e = std::fabs(a.transmittance - b.transmittance);
      if (e > worst) worst = e, at = alpha;
      colour = std::max(colour, std::fabs(a.colour - b.colour));
    }
    test::record("siblings_" + std::to_string(k) + "_t", worst);
    test::record("siblings_" + std::to_string(k) + "_at", at);
    test::record("siblings_" + std::to_string(k) + "_bound", k * kEpsilon / 2);
    test::record("siblings_" + std::to_string(k) + "_colour", colour);
  }
}

}  // namespace
}  // namespace voyager
