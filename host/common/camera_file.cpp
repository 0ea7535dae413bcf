#include "camera_file.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "failure.h"
#include "json_file.h"

namespace host {
namespace {

using Json = nlohmann::json;

constexpr double kLargestSide = 16384, kFarthest = 1e18;

class Reader {
 public:
  Reader(std::string where, const Json& json) : where_(std::move(where)), json_(json) {}

  Camera read() const {
    if (!json_.is_object()) refuse("it", "an object");
    Camera camera = {};
    camera.width = side("width");
    camera.height = side("height");
    const double cx = json_.contains("cx") ? number("cx") : camera.width / 2.0;
    const double cy = json_.contains("cy") ? number("cy") : camera.height / 2.0;
    if (voyFrustumFromIntrinsics(number("fx"), number("fy"), cx, cy, camera.width, camera.height,
                                 &camera.frustum) != VOY_SUCCESS)
      refuse("fx, fy, cx, cy", "a frustum: " + std::string(voyGetLastErrorMessage()));
    const glm::dvec3 position = vector(field("position"), "position");
    for (int i = 0; i < 3; ++i) {
      if (!(std::abs(position[i]) < kFarthest)) refuse("position", "metres below 1e18");
      camera.pose.position[i] = position[i];
    }
    set_orientation(camera.pose);
    return camera;
  }

 private:
  [[noreturn]] void refuse(const std::string& name, const std::string& expected) const {
    throw Failure(kRefusedInput, where_ + ": " + name + ": expected " + expected);
  }
  const Json& field(const std::string& name) const {
    const auto found = json_.find(name);
    if (found == json_.end()) refuse(name, "the field");
    return *found;
  }
  double number(const Json& json, const std::string& name) const {
    if (!json.is_number() || !std::isfinite(json.get<double>())) refuse(name, "finite numbers");
    return json.get<double>();
  }
  double number(const std::string& name) const { return number(field(name), name); }
  uint32_t side(const std::string& name) const {
    const double value = number(name);
    if (!(value >= 1 && value <= kLargestSide) || value != std::floor(value))
      refuse(name, "a whole number from 1 to 16384");
    return static_cast<uint32_t>(value);
  }
  glm::dvec3 vector(const Json& json, const std::string& name) const {
    if (!json.is_array() || json.size() != 3) refuse(name, "three numbers");
    return {number(json[0], name), number(json[1], name), number(json[2], name)};
  }

  // Rows written in decimal are not quite orthonormal: forward is kept as it is.
  void set_orientation(VoyPose& pose) const {
    const Json& rows = field("rotation");
    if (!rows.is_array() || rows.size() != 3) refuse("rotation", "three rows of three numbers");
    glm::dmat3 m;  // m[column]: right, down, forward
    for (int row = 0; row < 3; ++row) {
      const glm::dvec3 v = vector(rows[static_cast<size_t>(row)], "rotation");
      for (int column = 0; column < 3; ++column) m[column][row] = v[column];
    }
    const glm::dmat3 product = glm::transpose(m) * m;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (!(std::abs(product[i][j] - (i == j ? 1 : 0)) < 1e-3) || glm::determinant(m) < 0)
          refuse("rotation", "a rotation (orthonormal within 0.001, determinant +1)");
    const glm::dvec3 forward = glm::normalize(m[2]);
    const glm::dvec3 right = glm::normalize(m[0] - glm::dot(m[0], forward) * forward);
    const glm::dquat q =
        glm::normalize(glm::quat_cast(glm::dmat3(right, glm::cross(right, forward), -forward)));
    pose.orientation[0] = q.x;
    pose.orientation[1] = q.y;
    pose.orientation[2] = q.z;
    pose.orientation[3] = q.w;
  }

  std::string where_;
  const Json& json_;
};

}  // namespace

std::vector<Camera> read_cameras(const std::string& path) {
  const Json json = read_json(path);
  if (!json.is_array() || json.empty())
    throw Failure(kRefusedInput, path + ": expected JSON, an array of at least one camera");
  std::vector<Camera> cameras;
  for (size_t i = 0; i < json.size(); ++i)
    cameras.push_back(Reader(path + ": camera " + std::to_string(i), json[i]).read());
  return cameras;
}

}  // namespace host
