#include "tools/frame_path.h"

#include <algorithm>

#include "runtime/frame/eye_camera.h"

namespace voyager::tools {

FrameInput frame_input(const Camera& camera, double tau) {
  const auto& p = camera.pose.position;
  const auto& q = camera.pose.orientation;  // x, y, z, w
  const VoyFrustum frustum = camera.frustum();
  FrameInput input;
  input.tau = tau;
  voyager::Camera& view = input.eyes[0].camera;
  view.eye = {p[0], p[1], p[2]};
  view.world_to_view = world_to_view(normalise(Quatd{q[3], q[0], q[1], q[2]}));
  view.width = camera.width;
  view.height = camera.height;
  set_frustum(view, frustum.left, frustum.right, frustum.up, frustum.down);
  return input;
}

std::vector<FrameInput> frame_path(const std::vector<Camera>& cameras, double tau) {
  std::vector<FrameInput> path;
  path.reserve(cameras.size());
  for (const Camera& camera : cameras) path.push_back(frame_input(camera, tau));
  return path;
}

std::vector<FrameInput> stereo_path(const std::vector<Camera>& cameras, double tau) {
  std::vector<FrameInput> path;
  for (size_t i = 0; i + 1 < cameras.size(); i += 2) {
    path.push_back(frame_input(cameras[i], tau));
    path.back().eyes.push_back(frame_input(cameras[i + 1], tau).eyes[0]);
  }
  return path;
}

std::vector<size_t> spread_indices(size_t count, size_t most) {
  const size_t chosen = std::min(count, most);
  std::vector<size_t> indices;
  for (size_t i = 0; i < chosen; ++i)
    indices.push_back(chosen == 1 ? 0 : i * (count - 1) / (chosen - 1));
  return indices;
}

}  // namespace voyager::tools
