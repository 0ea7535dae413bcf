#include "godot_axes.h"

#include <cmath>

namespace voyager_godot {
namespace {

// (x, y, z, w) of the rotation with elements m[row][column], by the largest of its components, so
// that nothing is divided by a small number.
void to_quaternion(const double (&m)[3][3], double (&q)[4]) {
  const double trace = m[0][0] + m[1][1] + m[2][2];
  int largest = 3;
  double most = trace;
  for (int i = 0; i < 3; ++i)
    if (m[i][i] > most) most = m[largest = i][i];
  if (largest == 3) {
    q[3] = 1 + trace;
    for (int i = 0; i < 3; ++i) q[i] = m[(i + 2) % 3][(i + 1) % 3] - m[(i + 1) % 3][(i + 2) % 3];
  } else {
    const int i = largest, j = (i + 1) % 3, k = (i + 2) % 3;
    q[i] = 1 + m[i][i] - m[j][j] - m[k][k];
    q[j] = m[j][i] + m[i][j];
    q[k] = m[k][i] + m[i][k];
    q[3] = m[k][j] - m[j][k];
  }
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& component : q) component /= length;
}

}  // namespace

VoyPose scene_pose(const Transform& camera) {
  double rotation[3][3];
  VoyPose pose = {};
  for (int row = 0; row < 3; ++row) {
    const double sign = row == 0 ? 1 : -1;  // half a turn about x
    for (int column = 0; column < 3; ++column)
      rotation[row][column] = sign * static_cast<double>(camera[3 * row + column]);
    pose.position[row] = sign * static_cast<double>(camera[9 + row]);
  }
  to_quaternion(rotation, pose.orientation);
  return pose;
}

bool is_perspective(const Projection& projection) {
  return projection[11] == -1;
}

VoyFrustum frustum(const Projection& projection) {
  const double x = static_cast<double>(projection[0]), y = static_cast<double>(projection[5]);
  const double off_x = static_cast<double>(projection[8]),
               off_y = static_cast<double>(projection[9]);
  return {(off_x - 1) / x, (off_x + 1) / x, (off_y + 1) / y, (off_y - 1) / y};
}

double near_plane(const Projection& projection) {
  return static_cast<double>(projection[14]) / (static_cast<double>(projection[10]) - 1);
}

}  // namespace voyager_godot
