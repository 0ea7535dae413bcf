#pragma once
// cameras.json, as INRIA writes it.
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runtime/frame/backend.h"

namespace voyager::test {

inline Camera camera_of(const nlohmann::json& json) {
  const auto number = [&](const char* name, double otherwise) {
    return json.contains(name) ? json[name].get<double>() : otherwise;
  };
  Camera camera;
  camera.width = json["width"].get<uint32_t>();
  camera.height = json["height"].get<uint32_t>();
  camera.fx = json["fx"].get<double>();
  camera.fy = json["fy"].get<double>();
  camera.cx = number("cx", camera.width / 2.0);
  camera.cy = number("cy", camera.height / 2.0);
  // Camera to world, as rows: its columns are right, down and forward.
  for (int row = 0; row < 3; ++row) {
    const auto at = static_cast<size_t>(row);
    camera.eye[row] = json["position"][at].get<double>();
    for (int axis = 0; axis < 3; ++axis)
      camera.world_to_view.row[axis][row] =
          json["rotation"][at][static_cast<size_t>(axis)].get<double>();
  }
  return camera;
}

inline std::vector<Camera> cameras_of(const nlohmann::json& json) {
  std::vector<Camera> cameras;
  for (const nlohmann::json& camera : json) cameras.push_back(camera_of(camera));
  return cameras;
}

inline std::vector<Camera> read_cameras(const std::string& path) {
  std::ifstream file(path);
  return cameras_of(nlohmann::json::parse(file));
}

// A file with the first `count` of another's.
inline void write_first_cameras(const std::string& from, size_t count, const std::string& to) {
  std::ifstream file(from);
  nlohmann::json cameras = nlohmann::json::parse(file);
  cameras.erase(cameras.begin() + static_cast<std::ptrdiff_t>(count), cameras.end());
  std::ofstream(to) << cameras.dump();
}

// The same view in another size.
inline Camera resized(Camera camera, uint32_t width, uint32_t height) {
  const double x = static_cast<double>(width) / camera.width,
               y = static_cast<double>(height) / camera.height;
  camera.fx *= x, camera.cx *= x;
  camera.fy *= y, camera.cy *= y;
  camera.width = width, camera.height = height;
  return camera;
}

// `count` of them, first and last among them.
inline std::vector<Camera> spread(const std::vector<Camera>& cameras, size_t count) {
  if (cameras.size() <= count) return cameras;
  std::vector<Camera> some;
  for (size_t i = 0; i < count; ++i)
    some.push_back(cameras[i * (cameras.size() - 1) / (count - 1)]);
  return some;
}

}  // namespace voyager::test
