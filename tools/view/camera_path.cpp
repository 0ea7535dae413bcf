#include "tools/view/camera_path.h"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>

namespace voyager::view {
namespace {

glm::dvec3 position(const tools::Camera& camera) {
  const double* p = camera.pose.position;
  return {p[0], p[1], p[2]};
}

glm::dquat orientation(const tools::Camera& camera) {
  const double* q = camera.pose.orientation;
  return glm::normalize(glm::dquat(q[3], q[0], q[1], q[2]));
}

// Catmull-Rom: through b at t = 0 and c at t = 1.
glm::dvec3 curve(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d,
                 double t) {
  return 0.5 * (2.0 * b + t * (c - a) + t * t * (2.0 * a - 5.0 * b + 4.0 * c - d) +
                t * t * t * (3.0 * b - a - 3.0 * c + d));
}

}  // namespace

tools::Camera file_camera(const host::Camera& camera) {
  const VoyFrustum& f = camera.frustum;
  const double fx = camera.width / (f.right - f.left), fy = camera.height / (f.up - f.down);
  return {camera.pose, fx, fy, -f.left * fx, f.up * fy, camera.width, camera.height};
}

std::vector<tools::Camera> path_through(std::span<const tools::Camera> bookmarks, size_t count) {
  const auto at = [&](std::ptrdiff_t i) -> const tools::Camera& {
    return bookmarks[static_cast<size_t>(
        std::clamp<std::ptrdiff_t>(i, 0, std::ssize(bookmarks) - 1))];
  };
  std::vector<tools::Camera> path;
  for (size_t i = 0; i < count; ++i) {
    const double along = static_cast<double>(i) / static_cast<double>(count - 1) *
                         static_cast<double>(bookmarks.size() - 1);
    const auto from = static_cast<std::ptrdiff_t>(along);
    const double t = along - static_cast<double>(from);
    tools::Camera camera = bookmarks.front();
    const glm::dvec3 p = curve(position(at(from - 1)), position(at(from)), position(at(from + 1)),
                               position(at(from + 2)), t);
    const glm::dquat q = glm::slerp(orientation(at(from)), orientation(at(from + 1)), t);
    camera.pose = {{p.x, p.y, p.z}, {q.x, q.y, q.z, q.w}};
    path.push_back(camera);
  }
  return path;
}

}  // namespace voyager::view
