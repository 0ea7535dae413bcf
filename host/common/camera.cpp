#include "camera.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

namespace host {

float DepthConvention::metres(float depth) const {
  if (depth == far_plane()) return std::numeric_limits<float>::infinity();
  if (encoding == VOY_DEPTH_ENCODING_REVERSED) return static_cast<float>(near_z / depth);
  return static_cast<float>(near_z * far_z / (far_z - depth * (far_z - near_z)));
}

glm::dmat4 clip_from_view(const VoyFrustum& f, const DepthConvention& depth) {
  const double width = f.right - f.left, height = f.up - f.down;
  glm::dmat4 m(0);  // m[column][row]
  m[0][0] = 2 / width;
  m[2][0] = (f.right + f.left) / width;
  m[1][1] = -2 / height;
  m[2][1] = -(f.up + f.down) / height;
  m[2][3] = -1;
  if (depth.encoding == VOY_DEPTH_ENCODING_REVERSED) {
    m[3][2] = depth.near_z;
  } else {
    const double range = depth.far_z - depth.near_z;
    m[2][2] = -depth.far_z / range;
    m[3][2] = -depth.far_z * depth.near_z / range;
  }
  return m;
}

glm::dmat4 view_from_world(const VoyPose& pose) {
  const double* q = pose.orientation;
  const double* p = pose.position;
  const glm::dmat4 rotation = glm::mat4_cast(glm::normalize(glm::dquat(q[3], q[0], q[1], q[2])));
  return glm::transpose(rotation) * glm::translate(glm::dmat4(1), glm::dvec3(-p[0], -p[1], -p[2]));
}

}  // namespace host
