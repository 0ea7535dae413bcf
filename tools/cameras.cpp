#include "tools/cameras.h"

#include <fmt/core.h>

#include <Eigen/Geometry>

#include "runtime/base/error.h"
#include "runtime/math/screen_size.h"
#include "tools/json_fields.h"
#include "tools/json_file.h"

namespace voyager::tools {
namespace {

// right and forward are unit vectors at right angles.
void set_orientation(VoyPose& pose, const Eigen::Vector3d& right, const Eigen::Vector3d& forward) {
  Eigen::Matrix3d axes;  // OpenXR: x right, y up, z backward
  axes << right, right.cross(forward), -forward;
  const Eigen::Quaterniond q(axes);
  pose.orientation[0] = q.x();
  pose.orientation[1] = q.y();
  pose.orientation[2] = q.z();
  pose.orientation[3] = q.w();
}

// Camera to world, as rows; its columns are the camera's right, down and
// forward. Written in decimal, they are not quite orthonormal: forward is kept
// as it is, because it orders the splats (METHOD §6).
void read_orientation(const JsonFields& fields, VoyPose& pose) {
  const Eigen::Matrix3d m = fields.matrix("rotation", 3, 3, 3);
  if (!is_rotation(m)) fields.refuse("rotation", kRotationExpected);
  const Eigen::Vector3d forward = m.col(2).normalized();
  const Eigen::Vector3d right = (m.col(0) - m.col(0).dot(forward) * forward).normalized();
  set_orientation(pose, right, forward);
}

void check_frustum(const std::string& place, const Camera& camera) {
  try {
    camera.frustum();
  } catch (const Error& error) {
    throw Error(ErrorCode::refused_input,
                fmt::format("{}: fx, fy, cx, cy: {}", place, error.what()));
  }
}

Camera read_camera(const std::string& place, const nlohmann::json& json) {
  const JsonFields fields(place, json);
  Camera camera;
  camera.width = fields.side("width", kLargestSide);
  camera.height = fields.side("height", kLargestSide);
  camera.fx = fields.positive("fx");
  camera.fy = fields.positive("fy");
  camera.cx = fields.has("cx") ? fields.number("cx") : camera.width / 2.0;
  camera.cy = fields.has("cy") ? fields.number("cy") : camera.height / 2.0;
  const Eigen::Vector3d position = fields.vector("position");
  if (!(position.cwiseAbs().maxCoeff() < double{kMaxCoordinate}))
    fields.refuse("position", "metres below 1e18 in magnitude");
  for (int i = 0; i < 3; ++i) camera.pose.position[i] = position[i];
  read_orientation(fields, camera.pose);
  check_frustum(place, camera);
  return camera;
}

}  // namespace

VoyFrustum Camera::frustum() const {
  VoyFrustum f{};
  const VoyResult result = voyFrustumFromIntrinsics(fx, fy, cx, cy, width, height, &f);
  if (result != VOY_SUCCESS) throw Error(ErrorCode::refused_input, voyGetLastErrorMessage());
  return f;
}

Camera Camera::resized(uint32_t new_width, uint32_t new_height) const {
  Camera c = *this;
  const double x = static_cast<double>(new_width) / width,
               y = static_cast<double>(new_height) / height;
  c.fx *= x;
  c.cx *= x;
  c.fy *= y;
  c.cy *= y;
  c.width = new_width;
  c.height = new_height;
  return c;
}

Camera looking(const Vec3d& from, const Vec3d& right, const Vec3d& forward, uint32_t width,
               uint32_t height, double focal) {
  Camera camera{{}, focal, focal, width / 2.0, height / 2.0, width, height};
  for (int i = 0; i < 3; ++i) camera.pose.position[i] = from[i];
  set_orientation(camera.pose, {right.x, right.y, right.z}, {forward.x, forward.y, forward.z});
  return camera;
}

std::vector<Camera> read_cameras(const std::string& path) {
  const nlohmann::json json = read_json_file(path, "a cameras.json");
  if (!json.is_array() || json.empty())
    throw Error(ErrorCode::refused_input,
                fmt::format("{}: found {}, expected an array of at least one camera", path,
                            json.is_array() ? "an empty array" : json.type_name()));
  std::vector<Camera> cameras;
  for (size_t i = 0; i < json.size(); ++i)
    cameras.push_back(read_camera(fmt::format("{}: camera {}", path, i), json[i]));
  return cameras;
}

std::vector<Camera> camera_at(int64_t index, size_t eyes, const std::vector<Camera>& cameras,
                              const std::string& path) {
  if (cameras.size() < eyes)
    throw Error(ErrorCode::invalid_argument,
                fmt::format("--stereo: found {} camera in {}, expected two", cameras.size(), path));
  const auto last = static_cast<int64_t>(cameras.size() - eyes);
  if (index < 0 || index > last)
    throw Error(ErrorCode::invalid_argument,
                fmt::format("--camera: found {}, expected 0 to {}{} ({} has {} cameras)", index,
                            last, eyes == 2 ? " with --stereo" : "", path, cameras.size()));
  const auto first = cameras.begin() + static_cast<std::ptrdiff_t>(index);
  return {first, first + static_cast<std::ptrdiff_t>(eyes)};
}

void require_pairs(bool stereo, size_t count, const std::string& path) {
  if (stereo && count % 2 != 0)
    throw Error(ErrorCode::refused_input,
                fmt::format("{}: found {} cameras, expected pairs with --stereo", path, count));
}

}  // namespace voyager::tools
