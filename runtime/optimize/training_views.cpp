#include "runtime/optimize/training_views.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "runtime/lod/stand_in.h"
#include "runtime/math/halton.h"

namespace voyager {
namespace {

// Of the pictures. Those of few leaves are smaller: as many pixels teach a node, in less time.
constexpr uint32_t kWidth = 1920, kHeight = 1080, kSmaller = 4, kSmallerOfFew = 8;
constexpr double kFocal = 1400;
constexpr size_t kFewLeaves = 100'000;
// Of the cuts: coarser ones are not drawn where pictures count.
constexpr double kFinestTau = 0.75, kCoarsestTau = 15;
constexpr uint32_t kCutsOfView = 4;

constexpr size_t kSample = 1 << 16;
// A picture's pixel, at the leaf that is looked at, is this share of the native pixel or more:
// closer than that every cut has its leaves.
constexpr double kClosest = 0.3;
// Of a node's extent: such a pixel, taken as native, puts the closest eye where the node is drawn
// at τ = ½ (size = extent / distance = (2τ + 1) / focal length).
constexpr double kPixelOfExtent = 1 / (2 * kClosest);
// Sine of the elevation. What nobody has seen from below looks like nothing from there, and what
// learned it would look worse from above.
constexpr double kLowestOfFlat = -0.05, kLowestOfOther = -0.5;
constexpr double kNearestOfRadius = 0.02, kFarthestOfRadius = 3;
constexpr double kNearPlane = 0.1;  // of the distance, at most
// Views from cameras: how many at most, how many cameras are tried for a leaf, and the least sine
// of the angle to what is up, below which nothing says what is right.
constexpr double kShareOfCameras = 0.5, kLevelest = 1e-3;
constexpr uint32_t kCamerasTried = 64;
// Views from cameras and others then come by turns: of six times an index, the last digit in base
// 13 is below and above the middle one by turns. Of the index itself it is so in runs of six.
constexpr uint64_t kTurns = 6;
// How far eyes stand aside: of the way to the next camera, and of the way to the leaf at most;
// upwards and downwards a tenth of that, so that few are below the ground.
constexpr double kAside = 0.35, kMostAside = 0.25, kRise = 0.1;
constexpr size_t kMostCameras = 4096;

double between(double low, double high, double share) {
  return low * std::pow(high / low, share);
}

// Means of an even sample along each axis, ascending, without the fiftieth at either end.
struct Spread {
  std::vector<float> means[3];

  explicit Spread(const BakedScene& baked) {
    const size_t count = baked.leaves.size(), stride = (count + kSample - 1) / kSample;
    for (int axis = 0; axis < 3; ++axis) {
      for (size_t i = 0; i < count; i += stride)
        means[axis].push_back(local_mean(baked.leaves, i, baked.origin)[axis]);
      std::sort(means[axis].begin(), means[axis].end());
      const size_t outside = means[axis].size() / 50;
      means[axis].erase(means[axis].end() - static_cast<std::ptrdiff_t>(outside),
                        means[axis].end());
      means[axis].erase(means[axis].begin(),
                        means[axis].begin() + static_cast<std::ptrdiff_t>(outside));
    }
  }
  double side(int axis) const { return double{means[axis].back()} - double{means[axis].front()}; }
  double radius() const {
    return 0.5 * std::sqrt(side(0) * side(0) + side(1) * side(1) + side(2) * side(2));
  }
};

// What is up, and whether the scene is flat: narrower along one axis than a third of the others,
// as a landscape is. Trainers and viewers of 3DGS have y down (docs/conventions.md), maps z up.
struct Upward {
  Vec3d up;
  bool flat;
};
Upward upward(const Spread& spread) {
  const auto flat = [&](int axis) {
    return spread.side(axis) <
           std::min(spread.side((axis + 1) % 3), spread.side((axis + 2) % 3)) / 3;
  };
  if (flat(2)) return {{0, 0, 1}, true};
  return {{0, -1, 0}, flat(1)};
}

}  // namespace

// Of more than kMostCameras an even sample.
std::vector<TrainingViews::Stand> TrainingViews::stands_of(std::span<const TrainingCamera> cameras,
                                                           const Vec3d& origin) {
  const size_t stride = (cameras.size() + kMostCameras - 1) / kMostCameras;
  std::vector<Stand> stands;
  for (size_t i = 0; i < cameras.size(); i += stride) {
    stands.push_back({cameras[i], 0});
    stands.back().camera.position = cameras[i].position - origin;
  }
  for (Stand& stand : stands) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Stand& other : stands) {
      const Vec3d between = other.camera.position - stand.camera.position;
      if (const double squared = dot(between, between); squared > 0)
        nearest = std::min(nearest, squared);
    }
    if (std::isfinite(nearest)) stand.aside = kAside * std::sqrt(nearest);
  }
  return stands;
}

TrainingViews::TrainingViews(const BakedScene& baked, const LookedAt& looked_at,
                             std::span<const TrainingCamera> cameras)
    : baked_(baked),
      leaves_(looked_at.leaves),
      smaller_(looked_at.leaves < kFewLeaves ? kSmallerOfFew : kSmaller) {
  const Spread spread(baked);
  const Upward found = upward(spread);
  const Vec3d& up = found.up;
  const Vec3d level{1, 0, 0};
  axes_ = {{level, cross(up, level), up}};
  lowest_rise_ = found.flat ? kLowestOfFlat : kLowestOfOther;
  const double radius = std::max(spread.radius(), 1e-6);
  const double native = std::max(baked.leaves.native.pixel, kPixelOfExtent * looked_at.leaf_size);
  nearest_ = std::clamp(kClosest * native * kFocal / smaller_, 1e-3 * kNearestOfRadius * radius,
                        kNearestOfRadius * 10 * radius);
  if (!(native > 0)) nearest_ = kNearestOfRadius * radius;
  double farthest = kFarthestOfRadius * radius;
  if (looked_at.largest > 0)
    farthest = std::min(farthest, looked_at.largest * kFocal / smaller_ / (2 * kReferenceTau + 1));
  farthest_ = std::max(farthest, 4 * nearest_);
  stands_ = stands_of(cameras, {baked.origin[0], baked.origin[1], baked.origin[2]});
}

// From near the camera, if the leaf is in its picture, and not closer than views come.
std::optional<TrainingViews::Look> TrainingViews::look_from_camera(uint64_t index,
                                                                   const Vec3d& target) const {
  const double first = radical_inverse(index, 17);
  for (uint32_t k = 0; k < kCamerasTried; ++k) {
    const double share = first + static_cast<double>(k) / kCamerasTried;
    const auto at =
        static_cast<size_t>((share - std::floor(share)) * static_cast<double>(stands_.size()));
    const Stand& stand = stands_[std::min(at, stands_.size() - 1)];
    const TrainingCamera& camera = stand.camera;
    const double depth = (camera.world_to_view * (target - camera.position)).z;
    const double aside = std::min(stand.aside, kMostAside * depth);
    const auto by = [&](uint32_t base) { return aside * (2 * radical_inverse(index, base) - 1); };
    const Vec3d eye = camera.position + by(19) * axes_.row[0] + by(23) * axes_.row[1] +
                      kRise * by(29) * axes_.row[2];
    const Vec3d seen = camera.world_to_view * (target - eye);
    if (!(seen.z > nearest_ && seen.z < farthest_)) continue;
    const double x = camera.fx * seen.x / seen.z + camera.cx;
    const double y = camera.fy * seen.y / seen.z + camera.cy;
    if (!(x >= 0 && x <= camera.width && y >= 0 && y <= camera.height)) continue;
    const Vec3d away = eye - target;
    const double distance = std::sqrt(dot(away, away));
    const Vec3d outward = (1 / distance) * away;
    const Vec3d across = cross(axes_.row[2], outward);
    if (!(std::sqrt(dot(across, across)) > kLevelest)) continue;
    return Look{target, outward, (1 / std::sqrt(dot(across, across))) * across, distance};
  }
  return std::nullopt;
}

TrainingViews::Look TrainingViews::look(uint32_t k) const {
  const uint64_t index = uint64_t{k} + 1;
  const auto leaves = static_cast<double>(leaves_);
  const auto leaf = static_cast<size_t>(radical_inverse(index, 2) * leaves);
  const Vec3f mean = local_mean(baked_.leaves, leaf, baked_.origin);
  const Vec3d target{double{mean.x}, double{mean.y}, double{mean.z}};
  if (!stands_.empty() && radical_inverse(kTurns * index, 13) < kShareOfCameras)
    if (const auto found = look_from_camera(index, target)) return *found;
  const double around = 2 * std::numbers::pi * radical_inverse(index, 3);
  const double rise = lowest_rise_ + (1 - lowest_rise_) * radical_inverse(index, 5);
  const double level = std::sqrt(std::max(1 - rise * rise, 0.0));
  const Vec3d outward = level * std::cos(around) * axes_.row[0] +
                        level * std::sin(around) * axes_.row[1] + rise * axes_.row[2];
  const Vec3d right = -std::sin(around) * axes_.row[0] + std::cos(around) * axes_.row[1];
  return {target, outward, right, between(nearest_, farthest_, radical_inverse(index, 7))};
}

double TrainingViews::distance(uint32_t k) const {
  return look(k).distance;
}

TrainingView TrainingViews::operator()(uint32_t k) const {
  const Look look = this->look(k);
  const Vec3d forward = -1.0 * look.outward;
  TrainingView view;
  Camera& camera = view.camera;
  camera.eye = look.target + look.distance * look.outward +
               Vec3d{baked_.origin[0], baked_.origin[1], baked_.origin[2]};
  camera.world_to_view.row[0] = look.right;
  camera.world_to_view.row[1] = cross(forward, look.right);
  camera.world_to_view.row[2] = forward;
  camera.fx = camera.fy = kFocal / smaller_;
  camera.width = kWidth / smaller_, camera.height = kHeight / smaller_;
  camera.cx = 0.5 * camera.width, camera.cy = 0.5 * camera.height;
  // Scenes of a few centimetres are to be seen, too.
  camera.near_z = std::min(camera.near_z, kNearPlane * look.distance);
  // As METHOD §12 asks: at least 4, 8 where leaves are far below a pixel.
  const double pixels = look.distance / camera.fx / std::max(baked_.leaves.native.pixel, 1e-9);
  view.samples = pixels < 1 ? 4 : pixels < 3 ? 6 : 8;
  return view;
}

TrainingView TrainingViews::picture(uint32_t k) const {
  const uint32_t number = k / kCutsOfView;
  TrainingView view = (*this)(number);
  const double within = k % kCutsOfView + radical_inverse(uint64_t{number} + 1, 11);
  const double coarse = between(2 * kFinestTau + 1, 2 * kCoarsestTau + 1, within / kCutsOfView);
  view.tau = 0.5 * (coarse - 1);
  return view;
}

}  // namespace voyager
