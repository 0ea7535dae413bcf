#include "motion.h"

#include <cmath>

#include "json_reader.h"

namespace test_runtime {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kPairs = 240;
constexpr double kEyeDistance = 0.064;

Eye read_eye(const Reader& camera) {
  const double width = camera.number("width", 1, 1 << 24),
               height = camera.number("height", 1, 1 << 24);
  const double fx = camera.number("fx", 1e-3, 1e9), fy = camera.number("fy", 1e-3, 1e9);
  const double cx = camera.has("cx") ? camera.number("cx", -1e9, 1e9) : width / 2;
  const double cy = camera.has("cy") ? camera.number("cy", -1e9, 1e9) : height / 2;
  const auto position = camera.numbers("position", 3);
  const auto rows = camera.rows("rotation");
  Eigen::Matrix3d m;  // columns: right, down, forward
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = rows[static_cast<size_t>(i)];
  if (!(m * m.transpose()).isIdentity(1e-3) || m.determinant() < 0)
    camera.refuse("rotation", "a rotation (orthonormal within 0.001, determinant +1)");
  const Eigen::Vector3d forward = m.col(2).normalized();
  const Eigen::Vector3d right = (m.col(0) - m.col(0).dot(forward) * forward).normalized();
  Eigen::Matrix3d axes;  // OpenXR: right, up, backward
  axes << right, right.cross(forward), -forward;
  return {{Eigen::Quaterniond(axes), {position[0], position[1], position[2]}},
          -cx / fx,
          (width - cx) / fx,
          cy / fy,
          -(height - cy) / fy};
}

}  // namespace

XrFovf Eye::fov() const {
  const auto angle = [](double tangent) { return static_cast<float>(std::atan(tangent)); };
  return {angle(left), angle(right), angle(up), angle(down)};
}

Pose Head::centre() const {
  return {eyes[0].pose.orientation, (eyes[0].pose.position + eyes[1].pose.position) / 2};
}

Eye Head::view(size_t index) const {
  Eye eye = eyes[index % 2];
  if (index < 2) return eye;
  for (double* tangent : {&eye.left, &eye.right, &eye.up, &eye.down}) *tangent *= kInner;
  return eye;
}

Motion built_in_motion() {
  Motion motion;
  for (int i = 0; i < kPairs; ++i) {
    const double turn = 2 * kPi * i / kPairs;
    const Pose head = {
        Eigen::AngleAxisd(0.35 * std::sin(turn), Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(0.12 * std::sin(2 * turn), Eigen::Vector3d::UnitX()) *
            Eigen::AngleAxisd(0.05 * std::sin(3 * turn), Eigen::Vector3d::UnitZ()),
        {0.10 * std::sin(turn), 0.03 * std::sin(2 * turn), 0.08 * (std::cos(turn) - 1)}};
    Head pair;
    for (int eye = 0; eye < 2; ++eye) {
      const double side = eye == 0 ? -1 : 1, breath = 0.02 * std::sin(turn + eye);
      const double outer = 1.30 + breath, inner = 0.85 - breath;
      pair.eyes[static_cast<size_t>(eye)] = {
          head * Pose{Eigen::Quaterniond::Identity(), {side * kEyeDistance / 2, 0, 0}},
          eye == 0 ? -outer : -inner, eye == 0 ? inner : outer, 1.0 + breath, -1.2 + breath / 2};
    }
    motion.push_back(pair);
  }
  return motion;
}

Motion read_motion(const std::string& path) {
  const Json json = parse_json(path);
  if (!json.is_array() || json.empty() || json.size() % 2 != 0)
    throw std::runtime_error(path + ": found " + shown(json) +
                             ", expected an array of cameras, left and right in turn");
  Motion motion(json.size() / 2);
  for (size_t i = 0; i < json.size(); ++i)
    motion[i / 2].eyes[i % 2] = read_eye(Reader(path + ": camera " + std::to_string(i), json[i]));
  return motion;
}

}  // namespace test_runtime
