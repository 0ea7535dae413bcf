#include "tools/report/slow_paths.h"

#include <algorithm>
#include <cmath>

#include "runtime/frame/scene_gaussians.h"

namespace voyager::tools {
namespace {

constexpr double kStep = 0.25;  // pixels

bool is_in_picture(const voyager::Camera& camera, const Vec3d& p) {
  if (p.z < camera.near_z) return false;
  const double x = camera.fx * p.x / p.z + camera.cx, y = camera.fy * p.y / p.z + camera.cy;
  return x >= 0 && x < camera.width && y >= 0 && y < camera.height;
}

// Depth; 0: nothing is in the picture.
double median_depth(const Scene& scene, const voyager::Camera& camera) {
  std::vector<double> depths;
  const GaussianArrays arrays = gaussian_arrays(scene);
  const size_t leaves = scene.flat() ? gaussian_count(scene) : scene.leaves.size();
  for (size_t i = 0; i < leaves; ++i) {
    const size_t leaf = scene.flat() ? i : scene.leaves[i];
    if (leaf == kNoNode) continue;  // in a damaged chunk
    const Vec3f mean = arrays.mean(static_cast<uint32_t>(leaf));
    const Vec3d local{double{mean.x}, double{mean.y}, double{mean.z}};
    const Vec3d p = camera.world_to_view * (scene.origin + local - camera.eye);
    if (is_in_picture(camera, p)) depths.push_back(p.z);
  }
  if (depths.empty()) return 0;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

// Right, down, forward turned about down: to the right by `angle`, radians.
Mat3d turned(const Mat3d& world_to_view, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Mat3d m = world_to_view;
  for (int k = 0; k < 3; ++k) {
    const double right = world_to_view.row[0][k], forward = world_to_view.row[2][k];
    m.row[0][k] = c * right - s * forward;
    m.row[2][k] = s * right + c * forward;
  }
  return m;
}

}  // namespace

SlowPaths slow_paths(const FrameInput& first, const Scene& scene, size_t frames) {
  SlowPaths paths;
  const voyager::Camera& camera = first.eyes[0].camera;
  const double depth = median_depth(scene, camera);
  const Vec3d& forward = camera.world_to_view.row[2];
  for (size_t i = 0; i < frames; ++i) {
    const double pixels = kStep * static_cast<double>(i);
    FrameInput frame = first;
    frame.eyes[0].camera.eye = camera.eye + (pixels * depth / (0.5 * camera.width)) * forward;
    if (depth > 0) paths.dolly.push_back(frame);
    frame = first;
    frame.eyes[0].camera.world_to_view = turned(camera.world_to_view, pixels / camera.fx);
    paths.turn.push_back(frame);
  }
  return paths;
}

}  // namespace voyager::tools
