#pragma once
// A camera of Unreal's: a left-handed world, x forward, y right, z up, centimetres.
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "CoreMinimal.h"

namespace voyager::test {

struct UnrealCamera {
  FVector position, right, up, forward;
  double left_edge = -0.7, right_edge = 0.5, top_edge = 0.45, bottom_edge = -0.3;  // tangents
  double near_plane = 10, far_plane = std::numeric_limits<double>::infinity();     // centimetres

  // Turned by angles in radians: to the right, then upwards, then clockwise.
  static UnrealCamera at(const FVector& position, double yaw, double pitch, double roll) {
    const double cy = std::cos(yaw), sy = std::sin(yaw), cp = std::cos(pitch), sp = std::sin(pitch);
    const double cr = std::cos(roll), sr = std::sin(roll);
    const FVector ahead(cp * cy, cp * sy, sp), beside(-sy, cy, 0), above(-sp * cy, -sp * sy, cp);
    const auto mix = [](double a, const FVector& x, double b, const FVector& y) {
      return FVector(a * x.X + b * y.X, a * x.Y + b * y.Y, a * x.Z + b * y.Z);
    };
    UnrealCamera camera;
    camera.position = position;
    camera.forward = ahead;
    camera.right = mix(cr, beside, -sr, above);
    camera.up = mix(sr, beside, cr, above);
    return camera;
  }

  // FViewMatrices::GetInvViewMatrix.
  FMatrix view_to_world() const {
    return {{{right.X, right.Y, right.Z, 0},
             {up.X, up.Y, up.Z, 0},
             {forward.X, forward.Y, forward.Z, 0},
             {position.X, position.Y, position.Z, 1}}};
  }

  // Reversed: depth is 1 at the near plane and 0 at the far one.
  FMatrix projection() const {
    const double wide = right_edge - left_edge, high = top_edge - bottom_edge;
    const bool endless = std::isinf(far_plane);
    const double a = endless ? 0 : near_plane / (near_plane - far_plane);
    const double b = endless ? near_plane : -far_plane * near_plane / (near_plane - far_plane);
    return {{{2 / wide, 0, 0, 0},
             {0, 2 / high, 0, 0},
             {-(right_edge + left_edge) / wide, -(top_edge + bottom_edge) / high, a, 1},
             {0, 0, b, 0}}};
  }

  // What Unreal's depth buffer holds at a distance in metres along the view axis.
  float depth_at(double z) const {
    const FMatrix p = projection();
    return static_cast<float>(p.M[2][2] + p.M[3][2] / (100 * z));
  }

  // The same camera for `voyager render`, in the scene's axes: x right, y down, z forward.
  std::string cameras_json(uint32_t width, uint32_t height, const FVector& origin) const {
    const double fx = width / (right_edge - left_edge), fy = height / (top_edge - bottom_edge);
    const auto in_scene = [](const FVector& v) { return std::array<double, 3>{v.Y, -v.Z, v.X}; };
    const auto r = in_scene(right), u = in_scene(up), f = in_scene(forward);
    const auto p = in_scene({position.X - origin.X, position.Y - origin.Y, position.Z - origin.Z});
    const auto row = [&](size_t i) {
      return "[" + std::to_string(r[i]) + "," + std::to_string(-u[i]) + "," + std::to_string(f[i]) +
             "]";
    };
    return R"([{"id": 0, "width": )" + std::to_string(width) + R"(, "height": )" +
           std::to_string(height) + R"(, "position": [)" + std::to_string(p[0] / 100) + "," +
           std::to_string(p[1] / 100) + "," + std::to_string(p[2] / 100) + R"(], "rotation": [)" +
           row(0) + "," + row(1) + "," + row(2) + R"(], "fx": )" + std::to_string(fx) +
           R"(, "fy": )" + std::to_string(fy) + R"(, "cx": )" + std::to_string(-left_edge * fx) +
           R"(, "cy": )" + std::to_string(top_edge * fy) + "}]";
  }
};

}  // namespace voyager::test
