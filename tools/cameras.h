#pragma once
// INRIA cameras.json (id, img_name, width, height, position, rotation, fx, fy,
// and optionally cx, cy), turned to what voyRenderFrame takes.
#include <string>
#include <vector>

#include "runtime/math/vec.h"
#include "voyager/voyager.h"

namespace voyager::tools {

inline constexpr uint32_t kLargestSide = 16384;  // pixels

struct Camera {
  VoyPose pose;   // OpenXR axes, in the scene's world
  double fx, fy;  // pixels
  double cx, cy;  // pixels, from the top left corner
  uint32_t width, height;

  VoyFrustum frustum() const;
  // The same view in another size: fx, fy, cx, cy in proportion.
  Camera resized(uint32_t new_width, uint32_t new_height) const;
};

// right and forward are unit vectors at right angles; focal is in pixels.
Camera looking(const Vec3d& from, const Vec3d& right, const Vec3d& forward, uint32_t width,
               uint32_t height, double focal);

// Throws Error(refused_input) naming file, camera, field, found, expected.
std::vector<Camera> read_cameras(const std::string& path);

// The camera of the file `path` with this index, and the one after it where eyes is 2. Throws
// Error(invalid_argument) with the range.
std::vector<Camera> camera_at(int64_t index, size_t eyes, const std::vector<Camera>& cameras,
                              const std::string& path);

// Stereo takes cameras two by two. Throws Error(refused_input) where one is left over.
void require_pairs(bool stereo, size_t count, const std::string& path);

}  // namespace voyager::tools
