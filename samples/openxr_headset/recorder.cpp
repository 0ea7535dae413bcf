#include "recorder.h"

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <glm/mat3x3.hpp>
#include <vector>

#include "failure.h"
#include "files.h"
#include "json_file.h"
#include "pose.h"

namespace host {
namespace {

std::string picture_name(uint64_t frame, size_t view) {
  constexpr const char* kViews[kMostViews] = {"L", "R", "L_inner", "R_inner"};
  char name[48];
  std::snprintf(name, sizeof name, "%04llu_%s.png", static_cast<unsigned long long>(frame),
                kViews[view]);
  return name;
}

// As INRIA's cameras.json has it: pixels, and axes x right, y down, z forward.
nlohmann::json to_json(const Camera& camera, uint64_t id, const std::string& name) {
  const VoyFrustum& f = camera.frustum;
  const double fx = camera.width / (f.right - f.left), fy = camera.height / (f.up - f.down);
  const glm::dquat q = glm::normalize(from_voyager(camera.pose).orientation);
  const glm::dvec3 columns[] = {q * glm::dvec3(1, 0, 0), q * glm::dvec3(0, -1, 0),
                                q * glm::dvec3(0, 0, -1)};
  nlohmann::json rotation = nlohmann::json::array();
  for (int row = 0; row < 3; ++row)
    rotation.push_back({columns[0][row], columns[1][row], columns[2][row]});
  return {{"id", id},
          {"img_name", name},
          {"width", camera.width},
          {"height", camera.height},
          {"position", camera.pose.position},
          {"rotation", rotation},
          {"fx", fx},
          {"fy", fy},
          {"cx", -f.left * fx},
          {"cy", f.up * fy}};
}

constexpr const char* kCameras = "cameras.json";

bool is_picture(std::string_view name) {
  uint64_t frame = 0;
  std::from_chars(name.data(), name.data() + name.size(), frame);
  for (size_t view = 0; view < kMostViews; ++view)
    if (name == picture_name(frame, view)) return true;
  return false;
}

// With so many views a frame, each camera is that of the picture whose turn it is.
bool is_recording(const nlohmann::json& cameras, size_t views) {
  if (!cameras.is_array()) return false;
  for (size_t i = 0; i < cameras.size(); ++i)
    if (!cameras[i].is_object() ||
        cameras[i].value("img_name", nlohmann::json()) != picture_name(i / views, i % views))
      return false;
  return true;
}

// The pictures of a recording, from its cameras.json; any other file of that name is somebody's
// own.
std::vector<std::string> pictures_of(const std::string& path) {
  const nlohmann::json cameras = read_json(path);
  if (!is_recording(cameras, kEyes) && !is_recording(cameras, kMostViews))
    throw Failure(kBadUsage, "--readback: found " + path +
                                 ", which no recording has written, expected another folder");
  std::vector<std::string> names;
  for (const nlohmann::json& camera : cameras) names.push_back(camera["img_name"]);
  return names;
}

}  // namespace

Recorder::Recorder(std::string folder, const std::vector<std::string>& inputs)
    : folder_(std::move(folder)) {
  namespace fs = std::filesystem;
  const std::string cameras = folder_ + "/" + kCameras;
  try {
    fs::create_directories(folder_);
    require_distinct(cameras, inputs);
    require_pictures(folder_, inputs, is_picture);
    if (fs::exists(cameras)) {
      earlier_ = pictures_of(cameras);
      earlier_.emplace_back(kCameras);
    }
  } catch (const fs::filesystem_error& error) {
    throw Failure(kMachine, folder_ + ": " + error.code().message());
  }
  require_writable(cameras);
}

void Recorder::add(uint64_t frame, const std::vector<Camera>& views) {
  std::error_code ignored;
  for (const std::string& name : earlier_) std::filesystem::remove(folder_ + "/" + name, ignored);
  earlier_.clear();
  while (cameras_.size() > views.size() * frame) cameras_.erase(cameras_.size() - 1);
  for (size_t i = 0; i < views.size(); ++i)
    cameras_.push_back(to_json(views[i], cameras_.size(), picture_name(frame, i)));
}

void Recorder::write_picture(uint64_t frame, size_t view, VkExtent2D extent,
                             std::span<const uint8_t> rgba) const {
  write_png(folder_ + "/" + picture_name(frame, view), extent.width, extent.height, rgba);
}

void Recorder::write_cameras() const {
  if (cameras_.empty()) return;
  const std::string text = cameras_.dump(1) + "\n";
  write_file(folder_ + "/" + kCameras, std::as_bytes(std::span(text)));
}

}  // namespace host
