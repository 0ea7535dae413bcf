#include "VoyagerAxes.h"

#include <cmath>
#include <limits>

namespace {

constexpr double kMetresPerUnit = 0.01;

// (x, y, z, w) of the rotation with elements m[row][column], by the largest of its components, so
// that nothing is divided by a small number.
void ToQuaternion(const double (&m)[3][3], double (&q)[4]) {
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

FVoyagerCamera MakeVoyagerCamera(const FVector& Eye, const FMatrix& ViewToWorld,
                                 const FMatrix& Projection, const FVector& Origin) {
  const auto& view = ViewToWorld.M;
  double rotation[3][3];
  for (int column = 0; column < 3; ++column) {
    const double sign = column == 2 ? -1 : 1;  // Voyager's camera looks along -z
    rotation[0][column] = sign * view[column][1];
    rotation[1][column] = sign * -view[column][2];
    rotation[2][column] = sign * view[column][0];
  }
  FVoyagerCamera camera = {};
  ToQuaternion(rotation, camera.Pose.orientation);
  camera.Pose.position[0] = (Eye.Y - Origin.Y) * kMetresPerUnit;
  camera.Pose.position[1] = (Origin.Z - Eye.Z) * kMetresPerUnit;
  camera.Pose.position[2] = (Eye.X - Origin.X) * kMetresPerUnit;

  const auto& lens = Projection.M;
  camera.Frustum = {(-1 - lens[2][0]) / lens[0][0], (1 - lens[2][0]) / lens[0][0],
                    (1 - lens[2][1]) / lens[1][1], (-1 - lens[2][1]) / lens[1][1]};
  // Depth is lens[2][2] + lens[3][2] / z: 1 at the near plane and 0 at the far one.
  camera.NearZ = lens[3][2] / (1 - lens[2][2]) * kMetresPerUnit;
  camera.FarZ = lens[2][2] == 0 ? std::numeric_limits<double>::infinity()
                                : -lens[3][2] / lens[2][2] * kMetresPerUnit;
  return camera;
}
