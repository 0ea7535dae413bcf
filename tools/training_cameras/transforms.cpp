#include "tools/training_cameras/transforms.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <cmath>

#include "runtime/math/screen_size.h"
#include "tools/json_fields.h"
#include "tools/json_file.h"
#include "tools/training_cameras/byte_window.h"
#include "tools/training_cameras/colmap_model.h"
#include "tools/training_cameras/dataparser.h"

namespace voyager::tools {
namespace {

Vec3d vec(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

// One frame of the file.
class Frame {
 public:
  Frame(const JsonFields& top, const std::string& place, const nlohmann::json& json)
      : top_(top), own_(place, json) {}

  TrainingCamera read() const {
    refuse_panoramas();
    TrainingCamera camera{};
    camera.width = with("w").side("w", kLargestTrainingSide);
    camera.height = with("h").side("h", kLargestTrainingSide);
    camera.fx = focal("fl_x", "camera_angle_x", camera.width);
    camera.fy = has("fl_y") || has("camera_angle_y")
                    ? focal("fl_y", "camera_angle_y", camera.height)
                    : camera.fx;
    camera.cx = has("cx") ? with("cx").number("cx") : camera.width / 2.0;
    camera.cy = has("cy") ? with("cy").number("cy") : camera.height / 2.0;
    read_pose(camera);
    return camera;
  }

 private:
  bool has(const std::string& name) const { return own_.has(name) || top_.has(name); }
  // Where the field is; a refusal names the frame where it is in neither.
  const JsonFields& with(const std::string& name) const {
    return own_.has(name) || !top_.has(name) ? own_ : top_;
  }

  // Their pixels differ in size.
  void refuse_panoramas() const {
    if (!has("camera_model")) return;
    const JsonFields& fields = with("camera_model");
    const nlohmann::json& model = fields.field("camera_model");
    for (const char* refused : {"EQUIRECTANGULAR", "OMNIDIRECTIONALSTEREO_L",
                                "OMNIDIRECTIONALSTEREO_R", "VR180_L", "VR180_R", "ORTHOPHOTO"})
      if (model == refused) fields.refuse("camera_model", "a camera that has a focal length");
  }

  double focal(const std::string& name, const std::string& angle, uint32_t side) const {
    if (has(name) || !has(angle)) return with(name).positive(name);
    constexpr double kHalfTurn = 3.14159265358979323846;
    const double radians = with(angle).positive(angle);
    if (!(radians < kHalfTurn)) with(angle).refuse(angle, "radians below half a turn");
    return side / (2 * std::tan(radians / 2));
  }

  void read_pose(TrainingCamera& camera) const {
    const Eigen::MatrixXd m = own_.matrix("transform_matrix", 3, 4, 4);
    const Eigen::Matrix3d axes = m.leftCols(3);
    if (!is_rotation(axes)) own_.refuse("transform_matrix", kRotationExpected);
    const Eigen::Vector3d position = m.col(3);
    if (!(position.cwiseAbs().maxCoeff() < double{kMaxCoordinate}))
      own_.refuse("transform_matrix", "a position below 1e18 in magnitude");
    camera.position = vec(position);
    // Written in decimal, they are not quite orthonormal.
    const Eigen::Vector3d forward = -axes.col(2).normalized();
    const Eigen::Vector3d right = (axes.col(0) - axes.col(0).dot(forward) * forward).normalized();
    camera.world_to_view = {{vec(right), vec(forward.cross(right)), vec(forward)}};
  }

  const JsonFields& top_;
  JsonFields own_;
};

}  // namespace

std::vector<TrainingCamera> read_transforms(const std::string& path) {
  const nlohmann::json json = read_json_file(path, "a transforms.json");
  const JsonFields top(path, json);
  const nlohmann::json& frames = top.field("frames");
  if (!frames.is_array() || frames.empty()) top.refuse("frames", "an array of at least one frame");
  std::vector<TrainingCamera> cameras;
  for (size_t i = 0; i < frames.size(); ++i)
    cameras.push_back(Frame(top, fmt::format("{}: frame {}", path, i), frames[i]).read());
  bring_to_trained_world(cameras, path, top);
  return cameras;
}

}  // namespace voyager::tools
