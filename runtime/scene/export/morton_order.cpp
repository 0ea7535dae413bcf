#include "runtime/scene/export/morton_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "runtime/math/morton.h"

namespace voyager {
namespace {

struct Box {
  std::array<double, 3> least;
  double side;  // length of the longest
};

Box box_of(std::span<const float> positions) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Box box{{kInfinity, kInfinity, kInfinity}, 0};
  std::array<double, 3> most{-kInfinity, -kInfinity, -kInfinity};
  for (size_t i = 0; i < positions.size(); ++i) {
    box.least[i % 3] = std::min(box.least[i % 3], double{positions[i]});
    most[i % 3] = std::max(most[i % 3], double{positions[i]});
  }
  for (size_t k = 0; k < 3; ++k) box.side = std::max(box.side, most[k] - box.least[k]);
  return box;
}

// `side` is the same for all axes, so cells are cubes. A chunk of a .compressed.ply is then short
// along every axis, which keeps its position errors small.
uint32_t cell(double offset, double side) {
  constexpr double kLast = (1 << kMortonBits) - 1;
  return side > 0 ? static_cast<uint32_t>(std::fmin(std::fmax(offset / side, 0.0), 1.0) * kLast)
                  : 0;
}

}  // namespace

std::vector<uint32_t> morton_order(std::span<const float> positions) {
  const Box box = box_of(positions);
  std::vector<std::pair<uint64_t, uint32_t>> places(positions.size() / 3);
  for (size_t i = 0; i < places.size(); ++i) {
    std::array<uint32_t, 3> at;
    for (size_t k = 0; k < 3; ++k)
      at[k] = cell(double{positions[3 * i + k]} - box.least[k], box.side);
    places[i] = {morton_code(at[0], at[1], at[2]), static_cast<uint32_t>(i)};
  }
  std::sort(places.begin(), places.end());
  std::vector<uint32_t> order(places.size());
  std::transform(places.begin(), places.end(), order.begin(),
                 [](const auto& place) { return place.second; });
  return order;
}

}  // namespace voyager
