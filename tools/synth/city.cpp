#include "tools/synth/city.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/floating_point_mode.h"
#include "tools/synth/city_layout.h"
#include "tools/synth/gaussian_maker.h"
#include "tools/synth/pieces.h"

namespace voyager::synth {
namespace {

// Below this many Gaussians a block, windows lie on whole walls.
constexpr double kDetailedFrom = 10000.0;

// The surface's share of the Gaussians. A capture is densest where people
// walked, so the crossing of the walk gets more; a coarse city gets windows
// before leaves, and nothing so narrow that one Gaussian would be a streak.
double share(const Surface& s, bool detailed) {
  const Vec3d middle = s.corner + 0.5 * (s.u + s.v);
  const double d2 = (middle.x * middle.x + middle.z * middle.z) / (22.0 * 22.0);
  const double weight = s.weight() * (1.0 + 5.0 / (1.0 + d2 * d2));
  if (detailed) return weight;
  if (s.material == Material::leaves || s.material == Material::bark) return 0.5 * weight;
  if (s.material == Material::grass || s.material == Material::car_paint) return 0.3 * weight;
  const bool narrow = std::min(dot(s.u, s.u), dot(s.v, s.v)) < 0.45 * 0.45;
  return narrow ? 0.0 : weight;
}

void build_cell(Surfaces& surfaces, const Layout& layout, const Cell& cell, bool detailed) {
  surfaces.clear();
  add_ground(surfaces, cell, layout);
  for (const Building& building : cell.buildings) add_building(surfaces, building, detailed);
  for (const Tree& tree : cell.trees) add_tree(surfaces, tree, detailed);
  for (const Lamp& lamp : cell.lamps) add_lamp(surfaces, lamp);
  for (const Car& car : cell.cars) add_car(surfaces, car);
}

}  // namespace

void generate_city(const CityDesc& desc, const std::function<void(const GaussianCloud&)>& emit,
                   const Progress& progress) {
  const FloatingPointMode mode;
  const Layout layout = city_layout(desc);
  const double blocks = layout.blocks(), n = static_cast<double>(desc.gaussians);
  const bool detailed = n / (blocks * blocks) >= kDetailedFrom;
  const std::vector<Cell>& cells = layout.cells();
  Surfaces surfaces;
  double total = 0.0;
  for (const Cell& cell : cells) {
    build_cell(surfaces, layout, cell, detailed);
    for (const Surface& surface : surfaces) total += share(surface, detailed);
  }
  // The share of each surface is the difference of two rounded prefix sums, so
  // that they add up: the second pass sums the same numbers in the same order.
  GaussianMaker maker(layout, desc.sh_degree, emit);
  double sum = 0.0;
  uint64_t before = 0, seed = desc.seed;
  for (const Cell& cell : cells) {
    build_cell(surfaces, layout, cell, detailed);
    for (const Surface& surface : surfaces) {
      sum += share(surface, detailed);
      const auto after = static_cast<uint64_t>(std::floor(n * (sum / total)));
      maker.fill(surface, after - before, seed = combine(seed, after));
      before = after;
    }
    report(progress, "synthesising", before, desc.gaussians);
  }
  maker.flush();
}

float largest_coordinate(const CityDesc& desc) {
  return static_cast<float>(city_layout(desc).extent());
}

}  // namespace voyager::synth
