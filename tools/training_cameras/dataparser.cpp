#include "tools/training_cameras/dataparser.h"

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>

#include "runtime/math/screen_size.h"
#include "tools/json_file.h"
#include "tools/training_cameras/byte_window.h"

namespace voyager::tools {
namespace {

// x becomes scale * (rotation * x + translation).
struct Move {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  double scale = 1;
};

Move read_move(const JsonFields& fields, const std::string& transform, const std::string& scale) {
  Move move;
  if (fields.has(transform)) {
    const Eigen::MatrixXd m = fields.matrix(transform, 3, 4, 4);
    move.rotation = m.leftCols(3);
    move.translation = m.col(3);
    if (!is_rotation(move.rotation)) fields.refuse(transform, kRotationExpected);
  }
  if (fields.has(scale)) move.scale = fields.positive(scale);
  return move;
}

// The one that, after `first`, amounts to `both`. nerfstudio multiplies the transforms and the
// scales, each by itself.
Move rest_of(const Move& both, const Move& first) {
  Move rest;
  rest.rotation = both.rotation * first.rotation.transpose();
  rest.translation = both.translation - rest.rotation * first.translation;
  rest.scale = both.scale / first.scale;
  return rest;
}

void apply(const Move& move, TrainingCamera& camera) {
  const auto turned = [&](const Vec3d& v) -> Eigen::Vector3d {
    return move.rotation * Eigen::Vector3d(v.x, v.y, v.z);
  };
  const Eigen::Vector3d position = move.scale * (turned(camera.position) + move.translation);
  camera.position = {position.x(), position.y(), position.z()};
  for (Vec3d& row : camera.world_to_view.row) {
    const Eigen::Vector3d axis = turned(row).normalized();
    row = {axis.x(), axis.y(), axis.z()};
  }
}

void bring(std::vector<TrainingCamera>& cameras, const std::string& path, const Move& applied) {
  const std::filesystem::path beside =
      std::filesystem::path(path).parent_path() / "dataparser_transforms.json";
  std::error_code ignored;
  if (!std::filesystem::exists(beside, ignored)) return;
  const std::string name = beside.string();
  const nlohmann::json json = read_json_file(name, "a dataparser_transforms.json");
  const JsonFields fields(name, json);
  fields.field("transform");  // so that no other file is taken for it
  fields.field("scale");
  const Move move = rest_of(read_move(fields, "transform", "scale"), applied);
  for (TrainingCamera& camera : cameras) {
    apply(move, camera);
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::fabs(camera.position[axis]) < double{kMaxCoordinate}))
        refuse_cameras(name, "a transform that moves a camera 1e18 or more away", "a nearer place");
  }
}

}  // namespace

void bring_to_trained_world(std::vector<TrainingCamera>& cameras, const std::string& path) {
  bring(cameras, path, Move{});
}

void bring_to_trained_world(std::vector<TrainingCamera>& cameras, const std::string& path,
                            const JsonFields& top) {
  bring(cameras, path, read_move(top, "applied_transform", "applied_scale"));
}

}  // namespace voyager::tools
