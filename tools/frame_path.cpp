#include "tools/frame_path.h"

#include <algorithm>

namespace voyager::tools {

FrameInput frame_input(const Camera& camera, double tau) {
  const auto& p = camera.pose.position;
  const auto& q = camera.pose.orientation;  // x, y, z, w
  const Mat3d r = rotation(normalise(Quatd{q[3], q[0], q[1], q[2]}));
  const VoyFrustum frustum = camera.frustum();
  FrameInput input;
  input.tau = tau;
  voyager::Camera& view = input.camera;
  view.eye = {p[0], p[1], p[2]};
  // The pose's axes are right, up, backward; the view's right, down, forward.
  view.world_to_view = {{{r.row[0].x, r.row[1].x, r.row[2].x},
                         {-r.row[0].y, -r.row[1].y, -r.row[2].y},
                         {-r.row[0].z, -r.row[1].z, -r.row[2].z}}};
  view.width = camera.width;
  view.height = camera.height;
  view.fx = camera.width / (frustum.right - frustum.left);
  view.fy = camera.height / (frustum.up - frustum.down);
  view.cx = -frustum.left * view.fx;
  view.cy = frustum.up * view.fy;
  return input;
}

std::vector<FrameInput> frame_path(const std::vector<Camera>& cameras, double tau) {
  std::vector<FrameInput> path;
  path.reserve(cameras.size());
  for (const Camera& camera : cameras) path.push_back(frame_input(camera, tau));
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
