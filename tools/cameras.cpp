#include "tools/cameras.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "runtime/base/file.h"
#include "runtime/math/screen_size.h"
#include "tools/byte_size.h"
#include "tools/exit_code.h"

namespace voyager::tools {
namespace {

using Value = nlohmann::json;

constexpr uint64_t kLargestFile = uint64_t{1} << 30;
constexpr int kMostLevels = 16;  // cameras take 4, and other programs' fields may be in between

// The limit is there because a level of one byte takes 76 in memory.
Value parse(const std::string& path, const std::string& text) {
  return Value::parse(text, [&](int level, Value::parse_event_t, const Value&) {
    if (level > kMostLevels)
      throw Error(ErrorCode::refused_input,
                  fmt::format("{}: found JSON of more than {} levels in one another, expected a "
                              "cameras.json",
                              path, kMostLevels));
    return true;
  });
}

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

class CameraReader {
 public:
  CameraReader(const std::string& file, size_t index, const Value& json)
      : file_(file), index_(index), json_(json) {}

  Camera read() const {
    if (!json_.is_object()) refuse("", json_, "an object");
    Camera camera;
    camera.width = side("width");
    camera.height = side("height");
    camera.fx = positive("fx");
    camera.fy = positive("fy");
    camera.cx = json_.contains("cx") ? number("cx") : camera.width / 2.0;
    camera.cy = json_.contains("cy") ? number("cy") : camera.height / 2.0;
    const Eigen::Vector3d position = vector(field("position"), "position");
    if (!(position.cwiseAbs().maxCoeff() < double{kMaxCoordinate}))
      refuse("position", field("position"), "metres below 1e18 in magnitude");
    for (int i = 0; i < 3; ++i) camera.pose.position[i] = position[i];
    read_orientation(camera.pose);
    check_frustum(camera);
    return camera;
  }

 private:
  [[noreturn]] void refuse(const std::string& name, const Value& found,
                           const std::string& expected) const {
    std::string text = found.is_structured()
                           ? fmt::format("an {} of {}", found.type_name(), found.size())
                           : found.dump();
    if (text.size() > 60) text = text.substr(0, 60) + "…";
    throw Error(ErrorCode::refused_input,
                fmt::format("{}: camera {}{}{}: found {}, expected {}", file_, index_,
                            name.empty() ? "" : ": ", name, text, expected));
  }

  const Value& field(const std::string& name) const {
    const auto found = json_.find(name);
    if (found == json_.end())
      throw Error(
          ErrorCode::refused_input,
          fmt::format("{}: camera {}: found no field {}, expected one", file_, index_, name));
    return *found;
  }

  void check_frustum(const Camera& camera) const {
    try {
      camera.frustum();
    } catch (const Error& error) {
      throw Error(ErrorCode::refused_input,
                  fmt::format("{}: camera {}: fx, fy, cx, cy: {}", file_, index_, error.what()));
    }
  }

  double number(const std::string& name) const {
    const Value& value = field(name);
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      refuse(name, value, "a finite number");
    return value.get<double>();
  }
  double positive(const std::string& name) const {
    const double value = number(name);
    if (!(value > 0)) refuse(name, field(name), "a number above 0");
    return value;
  }
  uint32_t side(const std::string& name) const {
    const double value = number(name);
    if (!(value >= 1 && value <= kLargestSide) || value != std::floor(value))
      refuse(name, field(name), fmt::format("a whole number from 1 to {}", kLargestSide));
    return static_cast<uint32_t>(value);
  }
  Eigen::Vector3d vector(const Value& value, const std::string& name) const {
    Eigen::Vector3d v = Eigen::Vector3d::Zero();
    if (!value.is_array() || value.size() != 3) refuse(name, value, "three numbers");
    for (size_t i = 0; i < 3; ++i) {
      if (!value[i].is_number()) refuse(name, value, "three finite numbers");
      v[static_cast<Eigen::Index>(i)] = value[i].get<double>();
    }
    if (!v.allFinite()) refuse(name, value, "three finite numbers");
    return v;
  }

  // Camera to world, as rows; its columns are the camera's right, down and
  // forward. Written in decimal, they are not quite orthonormal: forward is kept
  // as it is, because it orders the splats (METHOD §6).
  void read_orientation(VoyPose& pose) const {
    const Value& rows = field("rotation");
    if (!rows.is_array() || rows.size() != 3)
      refuse("rotation", rows, "three rows of three numbers");
    Eigen::Matrix3d m;
    for (int i = 0; i < 3; ++i)
      m.row(i) = vector(rows[static_cast<size_t>(i)], "rotation").transpose();
    if (!(m * m.transpose()).isIdentity(1e-3) || m.determinant() < 0)
      refuse("rotation", rows, "a rotation (orthonormal within 0.001, determinant +1)");
    const Eigen::Vector3d forward = m.col(2).normalized();
    const Eigen::Vector3d right = (m.col(0) - m.col(0).dot(forward) * forward).normalized();
    set_orientation(pose, right, forward);
  }

  const std::string& file_;
  size_t index_;
  const Value& json_;
};

}  // namespace

VoyFrustum Camera::frustum() const {
  VoyFrustum f{};
  const VoyResult result = voyFovFromIntrinsics(fx, fy, cx, cy, width, height, &f);
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
  const auto source = open_file_source(path);
  if (source->size() > kLargestFile)
    throw Error(ErrorCode::refused_input,
                fmt::format("{}: found {}, expected a cameras.json of at most {}", path,
                            size_text(source->size()), size_text(kLargestFile)));
  std::string text(source->size(), '\0');
  source->read(0, std::as_writable_bytes(std::span(text)));
  Value json;
  try {
    json = parse(path, text);
  } catch (const Value::parse_error& error) {
    throw Error(ErrorCode::refused_input,
                fmt::format("{}: offset {}: found no JSON there, expected a cameras.json", path,
                            error.byte));
  } catch (const Value::exception& error) {
    throw Error(ErrorCode::refused_input,
                fmt::format("{}: found {}, expected a cameras.json", path, error.what()));
  }
  if (!json.is_array() || json.empty())
    throw Error(ErrorCode::refused_input,
                fmt::format("{}: found {}, expected an array of at least one camera", path,
                            json.type_name()));
  std::vector<Camera> cameras;
  for (size_t i = 0; i < json.size(); ++i) cameras.push_back(CameraReader(path, i, json[i]).read());
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
