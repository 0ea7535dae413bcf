#pragma once
// What COLMAP's text and binary files have in common.
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "runtime/scene/training_camera.h"

namespace voyager::tools {

// A picture's longer side is at most this, in pixels.
inline constexpr uint32_t kLargestTrainingSide = 1 << 20;

// A camera model: how many focal lengths its parameters begin with, 1 or 2, which two of the
// principal point follow, and how many parameters there are in all.
struct ColmapModel {
  std::string_view name;
  size_t focals, parameters;
};
inline constexpr size_t kMostColmapParameters = 16;

// By the number that a binary file has. Throws Error(refused_input) at `place` for one that is
// unknown or has no focal length, as the next does.
const ColmapModel& colmap_model(const std::string& place, int32_t number);
const ColmapModel& colmap_model(const std::string& place, std::string_view name);

// COLMAP's camera, which many pictures share.
struct ColmapLens {
  double fx, fy, cx, cy;
  uint32_t width, height;
};
using ColmapLenses = std::map<uint32_t, ColmapLens>;  // by CAMERA_ID

void add_lens(ColmapLenses& lenses, const std::string& place, uint32_t id, const ColmapModel& model,
              uint64_t width, uint64_t height, std::span<const double> parameters);

// COLMAP's image: QW, QX, QY, QZ, TX, TY, TZ, world to view.
TrainingCamera colmap_camera(const ColmapLenses& lenses, const std::string& place, uint32_t lens,
                             std::span<const double, 7> pose);

}  // namespace voyager::tools
