#include "unity_axes.h"

#include <cmath>

namespace voyager_unity {
namespace {

struct Rotation {
  double m[3][3];  // row, column
};

// (x, y, z, w), by the largest of its components, so that nothing is divided by a small number.
void to_quaternion(const Rotation& rotation, double (&q)[4]) {
  const auto& m = rotation.m;
  const double trace = m[0][0] + m[1][1] + m[2][2];
  int largest = 3;
  double most = trace;
  for (int i = 0; i < 3; ++i)
    if (m[i][i] > most) most = m[largest = i][i];
  if (largest == 3) {
    q[3] = 1 + trace;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      q[i] = m[k][j] - m[j][k];
    }
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

VoyPose scene_pose(const float (&camera_to_world)[16]) {
  constexpr double kSign[3] = {1, -1, 1};  // the mirror between the two worlds
  Rotation rotation;
  VoyPose pose;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      rotation.m[row][column] = kSign[row] * static_cast<double>(camera_to_world[4 * column + row]);
    pose.position[row] = kSign[row] * static_cast<double>(camera_to_world[12 + row]);
  }
  to_quaternion(rotation, pose.orientation);
  return pose;
}

VoyFrustum frustum(const float (&projection)[16]) {
  const double x = static_cast<double>(projection[0]), y = static_cast<double>(projection[5]);
  const double off_x = static_cast<double>(projection[8]),
               off_y = static_cast<double>(projection[9]);
  return {(off_x - 1) / x, (off_x + 1) / x, (off_y + 1) / y, (off_y - 1) / y};
}

}  // namespace voyager_unity
