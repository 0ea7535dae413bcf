#include "runtime/refine/viewpoint.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "runtime/math/halton.h"

namespace voyager {
namespace {

constexpr double kNearest = 0.03, kFarthest = 0.45;  // of the scene's radius
// Sine of the elevation: from any direction. Up is -y (docs/conventions.md). Looking only from
// above gained up to half a decibel on one scene, and was not taken (bench/NOTES.md, "Extents by
// looking").
constexpr double kLowestRise = -1;
constexpr size_t kSample = 1 << 16;

// Half the diagonal of the box of the middle 96 % of the means on each axis, of an even sample.
double radius_of(const BakedScene& baked) {
  const size_t count = baked.leaves.size(), stride = (count + kSample - 1) / kSample;
  double squares = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> means;
    for (size_t i = 0; i < count; i += stride)
      means.push_back(local_mean(baked.leaves, i, baked.origin)[axis]);
    std::sort(means.begin(), means.end());
    const size_t outside = means.size() / 50;
    const double side = double{means[means.size() - 1 - outside]} - double{means[outside]};
    squares += side * side;
  }
  return 0.5 * std::sqrt(squares);
}

}  // namespace

Viewpoints::Viewpoints(const BakedScene& baked) : baked_(baked), radius_(radius_of(baked)) {}

Viewpoint Viewpoints::operator()(uint32_t k) const {
  const uint64_t index = uint64_t{k} + 1;
  const auto leaves = static_cast<double>(baked_.leaves.size());
  const auto leaf = static_cast<size_t>(radical_inverse(index, 2) * leaves);
  const Vec3f target = local_mean(baked_.leaves, leaf, baked_.origin);
  const double around = 2 * std::numbers::pi * radical_inverse(index, 3);
  const double up = kLowestRise + (1 - kLowestRise) * radical_inverse(index, 5);
  const double level = std::sqrt(1 - up * up);
  const Vec3d forward{-level * std::cos(around), up, -level * std::sin(around)};
  const double distance =
      radius_ * kNearest * std::pow(kFarthest / kNearest, radical_inverse(index, 7));

  const Vec3d right{-std::sin(around), 0, std::cos(around)};
  Viewpoint view;
  view.eye = Vec3d{double{target.x}, double{target.y}, double{target.z}} - distance * forward;
  view.world_to_view.row[0] = right;
  view.world_to_view.row[1] = cross(forward, right);
  view.world_to_view.row[2] = forward;
  return view;
}

}  // namespace voyager
