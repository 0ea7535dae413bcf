#include "capture.h"

#include <cmath>
#include <cstdio>

#include "files.h"

namespace test_runtime {

Capture::Capture(std::string folder, Ranges frames, const Pose& root_in_scene)
    : folder_(std::move(folder)), frames_(std::move(frames)), root_in_scene_(root_in_scene) {}

nlohmann::ordered_json Capture::camera(const ViewImage& view, const std::string& name) const {
  const Pose pose = root_in_scene_ * view.in_root;
  const Eigen::Matrix3d axes = pose.orientation.toRotationMatrix();  // right, up, backward
  nlohmann::ordered_json rotation = nlohmann::ordered_json::array();
  for (int row = 0; row < 3; ++row)
    rotation.push_back({axes(row, 0), -axes(row, 1), -axes(row, 2)});
  const auto tangent = [](float angle) { return std::tan(double{angle}); };
  const double left = tangent(view.fov.angleLeft), up = tangent(view.fov.angleUp);
  const double fx = view.extent.width / (tangent(view.fov.angleRight) - left);
  const double fy = view.extent.height / (up - tangent(view.fov.angleDown));
  return {{"id", cameras_.size()},
          {"img_name", name},
          {"width", view.extent.width},
          {"height", view.extent.height},
          {"position", {pose.position.x(), pose.position.y(), pose.position.z()}},
          {"rotation", rotation},
          {"fx", fx},
          {"fy", fy},
          {"cx", -left * fx},
          {"cy", up * fy}};
}

nlohmann::ordered_json Capture::add(const std::vector<ViewImage>& views, int64_t frame,
                                    XrTime time) {
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  constexpr const char* kViews[] = {"L", "R", "L_inner", "R_inner"};
  for (size_t i = 0; i < views.size(); ++i) {
    const ViewImage& view = views[i];
    char name[32];
    std::snprintf(name, sizeof name, "%04d_%s", count_, kViews[i]);
    const std::string path = folder_ + "/" + name;
    write_png(path + ".png", static_cast<uint32_t>(view.extent.width),
              static_cast<uint32_t>(view.extent.height), view.rgb);
    if (!view.depth.empty())
      write_pfm(path + ".pfm", static_cast<uint32_t>(view.depth_extent.width),
                static_cast<uint32_t>(view.depth_extent.height), view.depth);
    cameras_.push_back(camera(view, name));
    files.push_back(name);
  }
  ++count_;
  return {{"frame", frame}, {"display_time", time}, {"images", files}};
}

void Capture::write_cameras() const {
  if (!folder_.empty() && count_ > 0)
    write_text(folder_ + "/cameras.json", cameras_.dump(1) + "\n");
}

}  // namespace test_runtime
