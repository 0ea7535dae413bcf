#include "runtime/refine/extents.h"

#include <algorithm>
#include <cmath>

namespace voyager {
namespace {

// How far what was measured is followed: as a power, less where extents shrink, as if so many
// pictures had shown what the extent says, and at most by a factor. A node that shows little error
// may be hidden in these pictures, and near in others.
constexpr double kFollow = 0.5, kFollowDown = 0.2, kBelief = 24, kMostChange = 16;

bool is_measured(const LodTree& tree, uint32_t node) {
  const NodeRecord& r = tree.records[node];
  return r.child_count != 0 && r.extent > 0 && std::isfinite(r.extent);
}

// What turns a squared gain into a squared extent: half of the nodes that gain anything are to
// grow.
double scale_of(const Measured& measured, const LodTree& tree) {
  std::vector<double> ratios;
  for (uint32_t n = 0; n < tree.size(); ++n) {
    if (!is_measured(tree, n) || !(measured.gain[n] > 0)) continue;
    const double extent = tree.records[n].extent;
    ratios.push_back(measured.pictures[n] * extent * extent / measured.gain[n]);
  }
  if (ratios.empty()) return 0;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

void change_extents(const Measured& measured, LodTree& tree) {
  const double scale = scale_of(measured, tree);
  for (uint32_t n = 0; n < tree.size(); ++n) {
    if (!is_measured(tree, n) || measured.pictures[n] == 0) continue;
    NodeRecord& r = tree.records[n];
    const double extent = r.extent, pictures = measured.pictures[n];
    const double found = std::max(measured.gain[n], 0.0) * scale + kBelief * extent * extent;
    const double square = found / (pictures + kBelief) / (extent * extent);
    const double change = std::pow(square, (square < 1 ? kFollowDown : kFollow) / 2);
    const auto changed =
        static_cast<float>(extent * std::clamp(change, 1 / kMostChange, kMostChange));
    if (std::isfinite(changed)) r.extent = changed;
  }
}

}  // namespace

void never_grow_downwards(LodTree& tree) {
  for (auto n = static_cast<uint32_t>(tree.size()); n-- > 0;) {
    NodeRecord& r = tree.records[n];
    for (uint32_t i = 0; i < r.child_count; ++i)
      r.extent = std::max(r.extent, tree.records[tree.first_child[n] + i].extent);
  }
}

void set_extents(const Measured& measured, LodTree& tree) {
  change_extents(measured, tree);
  never_grow_downwards(tree);
}

}  // namespace voyager
