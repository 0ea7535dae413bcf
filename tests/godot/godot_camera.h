#pragma once
// A camera of Godot's: a right-handed world, x right, y up, metres; it looks along -z.
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

struct GodotCamera {
  Vector position, right, up, back;
  double left_edge = -0.7, right_edge = 0.5, top_edge = 0.45, bottom_edge = -0.3;  // tangents
  double near_z = 0.3, far_z = 1000;

  // Turned by angles in radians: to the right, then upwards, then clockwise.
  static GodotCamera at(const Vector& position, double yaw, double pitch, double roll) {
    const double cy = std::cos(yaw), sy = std::sin(yaw), cp = std::cos(pitch), sp = std::sin(pitch);
    const Vector behind = {-sy * cp, -sp, cy * cp}, above = {-sy * sp, cp, cy * sp};
    const Vector beside = cross(above, behind);
    GodotCamera camera;
    camera.position = position;
    camera.back = behind;
    for (size_t i = 0; i < 3; ++i) {
      camera.right[i] = std::cos(roll) * beside[i] - std::sin(roll) * above[i];
      camera.up[i] = std::sin(roll) * beside[i] + std::cos(roll) * above[i];
    }
    return camera;
  }

  // Camera3D's Transform3D: the basis row by row, then the origin.
  std::array<float, 12> transform() const {
    std::array<float, 12> t = {};
    for (size_t i = 0; i < 3; ++i) {
      t[3 * i] = static_cast<float>(right[i]);
      t[3 * i + 1] = static_cast<float>(up[i]);
      t[3 * i + 2] = static_cast<float>(back[i]);
      t[9 + i] = static_cast<float>(position[i]);
    }
    return t;
  }

  // Projection: OpenGL's, column by column.
  std::array<float, 16> projection() const {
    std::array<float, 16> m = {};
    m[0] = static_cast<float>(2 / (right_edge - left_edge));
    m[5] = static_cast<float>(2 / (top_edge - bottom_edge));
    m[8] = static_cast<float>((right_edge + left_edge) / (right_edge - left_edge));
    m[9] = static_cast<float>((top_edge + bottom_edge) / (top_edge - bottom_edge));
    m[10] = static_cast<float>(-(far_z + near_z) / (far_z - near_z));
    m[11] = -1;
    m[14] = static_cast<float>(-2 * far_z * near_z / (far_z - near_z));
    return m;
  }

  // The same camera for `voyager render`: y and z of the world and of the camera point the other
  // way.
  std::string cameras_json(uint32_t width, uint32_t height) const {
    const double fx = width / (right_edge - left_edge), fy = height / (top_edge - bottom_edge);
    const auto row = [&](size_t i) {
      const double sign = i == 0 ? 1 : -1;
      return "[" + std::to_string(sign * right[i]) + "," + std::to_string(-sign * up[i]) + "," +
             std::to_string(-sign * back[i]) + "]";
    };
    return R"([{"id": 0, "width": )" + std::to_string(width) + R"(, "height": )" +
           std::to_string(height) + R"(, "position": [)" + std::to_string(position[0]) + "," +
           std::to_string(-position[1]) + "," + std::to_string(-position[2]) +
           R"(], "rotation": [)" + row(0) + "," + row(1) + "," + row(2) + R"(], "fx": )" +
           std::to_string(fx) + R"(, "fy": )" + std::to_string(fy) + R"(, "cx": )" +
           std::to_string(-left_edge * fx) + R"(, "cy": )" + std::to_string(top_edge * fy) + "}]";
  }
};

}  // namespace voyager::test
