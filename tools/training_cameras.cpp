#include "tools/training_cameras.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "tools/cameras.h"
#include "tools/training_cameras/colmap.h"
#include "tools/training_cameras/dataparser.h"
#include "tools/training_cameras/transforms.h"

namespace voyager::tools {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

std::vector<TrainingCamera> colmap_at(const fs::path& cameras, const fs::path& images) {
  std::vector<TrainingCamera> all = read_colmap(cameras.string(), images.string());
  bring_to_trained_world(all, images.string());
  return all;
}

TrainingCamera training_camera(const Camera& camera) {
  const double* q = camera.pose.orientation;  // right, up and backward, as columns
  const Mat3d m = rotation(normalise(Quatd{q[3], q[0], q[1], q[2]}));
  const double* p = camera.pose.position;
  return {{p[0], p[1], p[2]},
          {{{m.row[0].x, m.row[1].x, m.row[2].x},
            {-m.row[0].y, -m.row[1].y, -m.row[2].y},
            {-m.row[0].z, -m.row[1].z, -m.row[2].z}}},
          camera.fx,
          camera.fy,
          camera.cx,
          camera.cy,
          camera.width,
          camera.height};
}

std::vector<TrainingCamera> read_inria(const std::string& path) {
  std::vector<TrainingCamera> cameras;
  for (const Camera& camera : read_cameras(path)) cameras.push_back(training_camera(camera));
  return cameras;
}

// Where a file of JSON begins with a bracket or a brace, that; else 0.
char json_start(const std::string& path) {
  const auto source = open_file_source(path);
  ByteWindow bytes(*source);
  std::string_view start = bytes.peek();
  if (start.empty()) refuse_cameras(path, "an empty file", "cameras");
  // A count of COLMAP's may have a bracket's value, but then zeros.
  if (start.substr(0, 8).find('\0') != std::string_view::npos) return 0;
  if (start.starts_with("\xEF\xBB\xBF")) start.remove_prefix(3);
  start.remove_prefix(std::min(start.find_first_not_of(" \t\r\n"), start.size()));
  return !start.empty() && (start[0] == '[' || start[0] == '{') ? start[0] : '\0';
}

// COLMAP's other file lies beside the one that was given.
std::vector<TrainingCamera> colmap_beside(const fs::path& path) {
  const std::string name = path.filename().string();
  if (path.extension() == ".json")
    refuse_cameras(path.string(), "no JSON: its first character is neither [ nor {",
                   "a cameras.json or a transforms.json");
  if (name.starts_with("cameras"))
    return colmap_at(path, path.parent_path() / ("images" + name.substr(7)));
  if (name.starts_with("images"))
    return colmap_at(path.parent_path() / ("cameras" + name.substr(6)), path);
  refuse_cameras(
      path.string(), "neither JSON nor a file with COLMAP's name",
      "a cameras.json, a transforms.json, or COLMAP's cameras or images, text or binary");
}

std::vector<TrainingCamera> read_file(const std::string& path) {
  switch (json_start(path)) {
    case '[':
      return read_inria(path);
    case '{':
      return read_transforms(path);
    default:
      return colmap_beside(path);
  }
}

// INRIA's trainer prefers COLMAP's files, and COLMAP its binary ones.
std::vector<TrainingCamera> read_folder(const fs::path& path) {
  fs::path missing;  // of COLMAP's two files
  for (const fs::path& folder : {path, path / "sparse" / "0", path / "sparse"})
    for (const char* ending : {".bin", ".txt"}) {
      const fs::path cameras = folder / (std::string("cameras") + ending);
      const fs::path images = folder / (std::string("images") + ending);
      if (is_there(cameras) && is_there(images)) return colmap_at(cameras, images);
      if (missing.empty() && is_there(cameras)) missing = images;
      if (missing.empty() && is_there(images)) missing = cameras;
    }
  for (const char* name : {"transforms.json", "cameras.json"})
    if (is_there(path / name)) return read_file((path / name).string());
  if (!missing.empty())
    refuse_cameras(missing.string(), "no such file", "it beside COLMAP's other one");
  refuse_cameras(path.string(), "a folder without cameras",
                 "COLMAP's cameras and images, .bin or .txt, there or in sparse/0, a "
                 "transforms.json, or a cameras.json");
}

}  // namespace

std::vector<TrainingCamera> read_training_cameras(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored) ? read_folder(path) : read_file(path);
}

TrainingCamera downscaled(const TrainingCamera& camera, double factor) {
  const auto side = [&](uint32_t pixels) {
    return std::max(static_cast<uint32_t>(std::lround(pixels / factor)), 1u);
  };
  TrainingCamera small = camera;
  small.width = side(camera.width), small.height = side(camera.height);
  const double x = static_cast<double>(small.width) / camera.width,
               y = static_cast<double>(small.height) / camera.height;
  small.fx *= x, small.cx *= x;
  small.fy *= y, small.cy *= y;
  return small;
}

double usual_downscale(const TrainingCamera& camera) {
  return std::max(1.0, static_cast<double>(camera.width) / kUsualTrainingWidth);
}

}  // namespace voyager::tools
