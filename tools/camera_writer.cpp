#include "tools/camera_writer.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "runtime/base/file.h"

namespace voyager::tools {
namespace {

// Camera to world, as rows; columns are right, down, forward.
nlohmann::json rotation_rows(const VoyPose& pose) {
  const double* q = pose.orientation;
  Eigen::Matrix3d m = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
  m.col(1) *= -1;
  m.col(2) *= -1;
  nlohmann::json rows = nlohmann::json::array();
  for (int row = 0; row < 3; ++row) rows.push_back({m(row, 0), m(row, 1), m(row, 2)});
  return rows;
}

}  // namespace

void write_cameras(const std::string& path, std::span<const Camera> cameras) {
  nlohmann::json all = nlohmann::json::array();
  for (size_t i = 0; i < cameras.size(); ++i) {
    const Camera& camera = cameras[i];
    const double* p = camera.pose.position;
    all.push_back({{"id", i},
                   {"img_name", fmt::format("{:04}", i)},
                   {"width", camera.width},
                   {"height", camera.height},
                   {"position", {p[0], p[1], p[2]}},
                   {"rotation", rotation_rows(camera.pose)},
                   {"fx", camera.fx},
                   {"fy", camera.fy},
                   {"cx", camera.cx},
                   {"cy", camera.cy}});
  }
  const std::string text = all.dump(1) + "\n";
  AtomicFile file(path);
  file.write(std::as_bytes(std::span(text)));
  file.commit();
}

}  // namespace voyager::tools
