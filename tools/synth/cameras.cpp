#include <fmt/format.h>

#include "tools/synth/city_layout.h"
#include "tools/synth/portable_math.h"

namespace voyager::synth {
namespace {

constexpr int kPoses = 60;
constexpr double kHalfPi = 1.5707963267948966;

struct Pose {
  Vec3d position, forward;
  double bank;  // tangent of the roll, right wing down
};

// Up the street in the middle of the road, round the corner at the origin, and on.
Pose walk_pose(int i) {
  constexpr double kStep = 0.5, kStraight = 18.0, kRadius = 4.0;
  constexpr double kArc = kRadius * kHalfPi;
  const double s = kStep * i;
  const Vec3d centre{kRadius, -1.7, -kRadius};
  if (s < kStraight) return {{0.0, -1.7, -kRadius - kStraight + s}, {0.0, -0.06, 1.0}, 0.0};
  if (s > kStraight + kArc)
    return {{kRadius + (s - kStraight - kArc), -1.7, 0.0}, {1.0, -0.06, 0.0}, 0.0};
  const double angle = (s - kStraight) / kRadius, c = portable_cos(angle), d = portable_sin(angle);
  return {centre + Vec3d{-kRadius * c, 0.0, kRadius * d}, {d, -0.06, c}, 0.0};
}

// From the middle of the road to the wall of the house at the corner, which it then looks at all
// the way along.
Pose close_up_pose(int i) {
  constexpr int kApproach = kPoses / 2;
  constexpr double kWall = -kHalfStreet, kNear = 0.3, kStart = -0.8, kAbreast = -11.0, kStep = 0.2;
  const double share = i < kApproach ? static_cast<double>(i) / (kApproach - 1) : 1.0;
  const double x = kStart + share * (kWall + kNear - kStart);
  const double z = kAbreast - (i < kApproach ? 0.0 : kStep * (i - kApproach + 1));
  return {{x, -1.7, z}, {-1.0, 0.0, 0.0}, 0.0};
}

// An arc around the middle of the city, sinking gently, looking ahead and inwards.
Pose flight_pose(int i) {
  const double t = static_cast<double>(i) / (kPoses - 1), angle = -0.5 + 1.3 * t;
  const double s = portable_sin(angle), c = portable_cos(angle);
  const Vec3d position{75.0 * s, -76.0 + 16.0 * t, -75.0 * c};
  const Vec3d inwards{-s, 0.0, c}, ahead{c, 0.0, s};
  return {position, inwards + 0.35 * ahead + Vec3d{0.0, 0.72, 0.0},
          0.05 + 0.12 * portable_sin(3.0 * t)};
}

std::string entry(int id, const std::string& name, const Pose& pose) {
  const Vec3d forward = unit(pose.forward);
  const Vec3d level = unit(cross({0.0, 1.0, 0.0}, forward));
  const Vec3d right = unit(level + pose.bank * cross(forward, level));
  const Vec3d down = cross(forward, right);
  const Vec3d& p = pose.position;
  std::string rows;
  for (int k = 0; k < 3; ++k)
    rows += fmt::format("{}[{}, {}, {}]", k ? ", " : "", right[k], down[k], forward[k]);
  return fmt::format(
      "{{\"id\": {}, \"img_name\": \"{}\", \"width\": 960, \"height\": 540, \"position\": [{}, {}, "
      "{}], "
      "\"rotation\": [{}], \"fx\": 700.0, \"fy\": 700.0}}",
      id, name, p.x, p.y, p.z, rows);
}

}  // namespace

std::string city_close_up_json(const CityDesc& desc) {
  city_layout(desc);  // as city_cameras_json()
  std::string json = "[";
  for (int i = 0; i < kPoses; ++i)
    json += entry(i, fmt::format("closeup_{:03}", i), close_up_pose(i)) +
            (i + 1 < kPoses ? ",\n" : "]\n");
  return json;
}

std::string city_cameras_json(const CityDesc& desc) {
  city_layout(desc);  // refuses what generate_city refuses; every city has the same middle
  std::string json = "[";
  for (int i = 0; i < kPoses; ++i)
    json += entry(i, fmt::format("walk_{:03}", i), walk_pose(i)) + ",\n";
  for (int i = 0; i < kPoses; ++i)
    json += entry(kPoses + i, fmt::format("flight_{:03}", i), flight_pose(i)) +
            (i + 1 < kPoses ? ",\n" : "]\n");
  return json;
}

}  // namespace voyager::synth
