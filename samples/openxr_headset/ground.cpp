#include "ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace host {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kEyeHeight = 1.6;  // metres above the ground
constexpr double kStep = 1;         // metres up or down that are still the same ground
constexpr int kSide = 128;          // pixels of the picture

using Cell = std::array<int, 2>;  // column (east is +x) and row (south is +z) of the picture

struct Bounds {
  glm::dvec3 low, high;  // in the upright frame
};

Bounds upright_bounds(const VoySceneInfo& s) {
  return {{s.boundsMin[0], -s.boundsMax[1], -s.boundsMax[2]},
          {s.boundsMax[0], -s.boundsMin[1], -s.boundsMin[2]}};
}

// The heights that are seen from above, and where: so far above that it is nearly a map.
class Map {
 public:
  Map(const voy::Device& device, const voy::Scene& scene, const Bounds& bounds)
      : centre_((bounds.low + bounds.high) / 2.0),
        half_(std::max({bounds.high.x - centre_.x, bounds.high.z - centre_.z, 1e-3})),
        top_(bounds.high.y + kRise * half_),
        depth_(size_t{kSide} * kSide) {
    draw(device, scene);
  }

  bool inside(const Cell& cell) const {
    return std::min(cell[0], cell[1]) >= 0 && std::max(cell[0], cell[1]) < kSide;
  }
  double depth(const Cell& cell) const {  // below the eye, metres; +inf where nothing is
    return double{depth_[static_cast<size_t>(cell[1]) * kSide + static_cast<size_t>(cell[0])]};
  }
  glm::dvec3 place(const Cell& cell) const {
    const double z = depth(cell), metres = 2 * z / kRise / kSide;
    return {centre_.x + metres * (cell[0] + 0.5 - 0.5 * kSide), top_ - z,
            centre_.z + metres * (cell[1] + 0.5 - 0.5 * kSide)};
  }

 private:
  static constexpr double kRise = 20;  // the eye's height above the scene, in its half widths

  void draw(const voy::Device& device, const voy::Scene& scene);

  glm::dvec3 centre_;
  double half_, top_;
  std::vector<float> depth_;
};

void Map::draw(const voy::Device& device, const voy::Scene& scene) {
  const VoyScene scenes[] = {scene.get()};
  VoyViewDesc view_desc = VOY_VIEW_DESC_INIT;
  view_desc.instanceCount = 1;
  view_desc.scenes = scenes;
  view_desc.maxWidth = view_desc.maxHeight = kSide;
  voy::View view = device.create_view(view_desc);
  VoyTargetDesc target_desc = VOY_TARGET_DESC_INIT;
  target_desc.colorFormat = VOY_COLOR_FORMAT_NONE;
  target_desc.width = target_desc.height = kSide;
  target_desc.depth = depth_.data();
  const voy::Target target = device.create_target(target_desc);
  const Pose down = {{centre_.x, top_, centre_.z}, glm::angleAxis(-kPi / 2, glm::dvec3(1, 0, 0))};
  VoyFrameEye eye = VOY_FRAME_EYE_INIT;
  eye.pose = to_voyager(scene_from_upright() * down);
  eye.frustum = {-1 / kRise, 1 / kRise, 1 / kRise, -1 / kRise};
  eye.target = target.get();
  VoyFrame frame = VOY_FRAME_INIT;
  frame.eyeCount = 1;
  frame.eyes = &eye;
  view.render(frame);
}

Cell next(const Cell& cell, const Cell& step) {
  return {cell[0] + step[0], cell[1] + step[1]};
}

bool level(const Map& map, const Cell& a, const Cell& b) {
  return map.inside(b) && std::abs(map.depth(a) - map.depth(b)) < kStep;
}

// Nothing of another height around it, walls and treetops.
bool open(const Map& map, const Cell& cell) {
  constexpr int kAround = 2;
  for (int x = -kAround; x <= kAround; ++x)
    for (int z = -kAround; z <= kAround; ++z)
      if (!level(map, cell, next(cell, {x, z}))) return false;
  return true;
}

// Half of what is seen lies as high as this or higher; roofs and trees do.
double middle_depth(const Map& map) {
  std::vector<double> depths;
  for (int z = 0; z < kSide; ++z)
    for (int x = 0; x < kSide; ++x)
      if (std::isfinite(map.depth({x, z}))) depths.push_back(map.depth({x, z}));
  if (depths.empty()) return INFINITY;
  std::sort(depths.begin(), depths.end());
  return depths[depths.size() / 2];
}

std::optional<Cell> open_ground(const Map& map) {
  const double least = middle_depth(map);
  std::optional<Cell> best;
  int nearest = INT32_MAX;
  for (int z = 0; z < kSide; ++z)
    for (int x = 0; x < kSide; ++x) {
      const int way = std::abs(2 * x - kSide + 1) + std::abs(2 * z - kSide + 1);
      if (way >= nearest || !(map.depth({x, z}) >= least) || !open(map, {x, z})) continue;
      best = {x, z};
      nearest = way;
    }
  return best;
}

// Of the four: where the ground goes on the farthest.
double longest_view(const Map& map, const Cell& from) {
  constexpr struct {
    Cell step;
    double yaw;
  } kWays[] = {{{0, -1}, 0}, {{-1, 0}, kPi / 2}, {{0, 1}, kPi}, {{1, 0}, -kPi / 2}};
  double best = 0;
  int longest = -1;
  for (const auto& way : kWays) {
    int length = 0;
    for (Cell at = from; level(map, at, next(at, way.step)); at = next(at, way.step)) ++length;
    if (length <= longest) continue;
    longest = length;
    best = way.yaw;
  }
  return best;
}

}  // namespace

Pose scene_from_upright() {
  return {{0, 0, 0}, {0, 1, 0, 0}};
}

Pose stand_on_ground(const voy::Device& device, const voy::Scene& scene) {
  const Bounds bounds = upright_bounds(scene.info());
  const Map map(device, scene, bounds);
  const std::optional<Cell> cell = open_ground(map);
  Pose pose = turned(cell ? longest_view(map, *cell) : 0);
  pose.position = cell ? map.place(*cell) : (bounds.low + bounds.high) / 2.0;
  pose.position.y += kEyeHeight;
  return pose;
}

}  // namespace host
