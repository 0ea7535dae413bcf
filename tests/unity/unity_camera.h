#pragma once
// A camera of Unity's: a left-handed world, x right, y up, z forward, metres.
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace voyager::test {

using Vector = std::array<double, 3>;

inline double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct UnityCamera {
  Vector position, right, up, forward;
  double left_edge, right_edge, top_edge, bottom_edge;  // tangents of the frustum
  float near_z = 0.3f, far_z = 1000.0f;

  // Turned by angles in radians: to the right, then upwards, then clockwise.
  static UnityCamera at(const Vector& position, double yaw, double pitch, double roll) {
    const double cy = std::cos(yaw), sy = std::sin(yaw), cp = std::cos(pitch), sp = std::sin(pitch);
    const Vector ahead = {sy * cp, sp, cy * cp}, above = {-sy * sp, cp, -cy * sp};
    const Vector beside = cross(above, ahead);  // x = y × z, in numbers, with either hand
    Vector right, up;
    for (size_t i = 0; i < 3; ++i) {
      right[i] = std::cos(roll) * beside[i] - std::sin(roll) * above[i];
      up[i] = std::sin(roll) * beside[i] + std::cos(roll) * above[i];
    }
    return {position, right, up, ahead, -0.7, 0.5, 0.45, -0.3};
  }

  // Camera.cameraToWorldMatrix, whose camera looks along -z, column by column.
  std::array<float, 16> camera_to_world() const {
    std::array<float, 16> m = {};
    for (size_t i = 0; i < 3; ++i) {
      m[i] = static_cast<float>(right[i]);
      m[4 + i] = static_cast<float>(up[i]);
      m[8 + i] = static_cast<float>(-forward[i]);
      m[12 + i] = static_cast<float>(position[i]);
    }
    m[15] = 1;
    return m;
  }

  // Camera.projectionMatrix: OpenGL's, column by column.
  std::array<float, 16> projection() const {
    const double n = static_cast<double>(near_z), f = static_cast<double>(far_z);
    std::array<float, 16> m = {};
    m[0] = static_cast<float>(2 / (right_edge - left_edge));
    m[5] = static_cast<float>(2 / (top_edge - bottom_edge));
    m[8] = static_cast<float>((right_edge + left_edge) / (right_edge - left_edge));
    m[9] = static_cast<float>((top_edge + bottom_edge) / (top_edge - bottom_edge));
    m[10] = static_cast<float>(-(f + n) / (f - n));
    m[11] = -1;
    m[14] = static_cast<float>(-2 * f * n / (f - n));
    return m;
  }

  // What Unity's depth buffer holds at a distance along the view axis: reversed.
  float depth_at(double z) const {
    const double n = static_cast<double>(near_z), f = static_cast<double>(far_z);
    return static_cast<float>(n * (f - z) / (z * (f - n)));
  }

  // The same camera for `voyager render`: y of the world and of the camera point down.
  std::string cameras_json(uint32_t width, uint32_t height) const {
    const double fx = width / (right_edge - left_edge), fy = height / (top_edge - bottom_edge);
    const auto row = [&](size_t i) {
      const double sign = i == 1 ? -1 : 1;
      return "[" + std::to_string(sign * right[i]) + "," + std::to_string(-sign * up[i]) + "," +
             std::to_string(sign * forward[i]) + "]";
    };
    return R"([{"id": 0, "width": )" + std::to_string(width) + R"(, "height": )" +
           std::to_string(height) + R"(, "position": [)" + std::to_string(position[0]) + "," +
           std::to_string(-position[1]) + "," + std::to_string(position[2]) +
           R"(], "rotation": [)" + row(0) + "," + row(1) + "," + row(2) + R"(], "fx": )" +
           std::to_string(fx) + R"(, "fy": )" + std::to_string(fy) + R"(, "cx": )" +
           std::to_string(-left_edge * fx) + R"(, "cy": )" + std::to_string(top_edge * fy) + "}]";
  }
};

}  // namespace voyager::test
