#include "runtime/scene/transform.h"

#include <Eigen/Core>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "runtime/base/error.h"
#include "runtime/scene/sanitise.h"

namespace voyager {
namespace {

using Matrix = Eigen::Matrix3d;
using Svd = Eigen::JacobiSVD<Matrix>;

constexpr double kSimilar = 1e-6;  // how far apart the scales of a uniform one may be, of one

Matrix to_eigen(const Mat3d& m) {
  Matrix matrix;
  for (int i = 0; i < 3; ++i) matrix.row(i) << m.row[i].x, m.row[i].y, m.row[i].z;
  return matrix;
}

Mat3d from_eigen(const Matrix& m) {
  Mat3d matrix;
  for (int i = 0; i < 3; ++i) matrix.row[i] = {m(i, 0), m(i, 1), m(i, 2)};
  return matrix;
}

bool is_finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void require_usable(const Affine& affine, const std::string& what) {
  bool usable = true;
  for (const Vec3d& row : affine.linear.row) usable = usable && is_finite(row);
  for (int axis = 0; axis < 3; ++axis)
    usable = usable && std::fabs(affine.offset[axis]) < kMaxCoordinate;
  if (!usable)
    throw Error(ErrorCode::refused_input,
                what +
                    ": found a number that is not finite or too large, expected finite ones, "
                    "and a translation below 1e18");
}

// What sanitise() makes of it, which comes too late for a rotation that is turned.
void mend_rotation(float* q, ImportReport& report) {
  double squared = 0;
  for (int i = 0; i < 4; ++i) squared += double{q[i]} * double{q[i]};
  if (squared > 0 && std::isfinite(squared)) return;
  q[0] = 1, q[1] = q[2] = q[3] = 0;
  ++report.repaired_rotation;
}

// Seen from itself a Gaussian has no handedness: a mirror is a rotation and a reflection through
// the mean.
Mat3d without_mirror(const Mat3d& m) {
  if (determinant(m) > 0) return m;
  return {{-1.0 * m.row[0], -1.0 * m.row[1], -1.0 * m.row[2]}};
}

}  // namespace

CloudTransform::CloudTransform(const Affine& affine, const std::string& what) : affine_(affine) {
  require_usable(affine, what);
  const Svd svd(to_eigen(affine.linear), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& scales = svd.singularValues();
  if (!(scales[0] <= kMostScale && scales[2] >= 1 / kMostScale))
    throw Error(ErrorCode::refused_input,
                what + ": found scales from " + std::to_string(scales[2]) + " to " +
                    std::to_string(scales[0]) + ", expected 1e-9 to 1e9: none that flattens");
  similar_ = scales[0] - scales[2] <= kSimilar * scales[0];
  scale_ = std::cbrt(scales[0] * scales[1] * scales[2]);
  const Mat3d nearest = from_eigen(svd.matrixU() * svd.matrixV().transpose());
  rotation_ = quaternion_of(without_mirror(nearest));
  sh_ = sh_rotation(nearest);
}

void CloudTransform::move(GaussianCloud& cloud, const std::array<double, 3>& origin) const {
  for (size_t i = 0; i < cloud.position.size(); i += 3) {
    float* p = &cloud.position[i];
    Vec3d world;
    for (int axis = 0; axis < 3; ++axis)
      world[axis] = cloud.origin[static_cast<size_t>(axis)] + static_cast<double>(p[axis]);
    world = affine_ * world;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = static_cast<float>(world[axis] - origin[static_cast<size_t>(axis)]);
  }
  cloud.origin = origin;
}

void CloudTransform::turn(GaussianCloud& cloud) const {
  const auto grown = static_cast<float>(std::log(scale_));
  for (float& log_scale : cloud.log_scale) log_scale += grown;
  for (size_t i = 0; i < cloud.rotation.size(); i += 4) {
    float* q = &cloud.rotation[i];
    mend_rotation(q, cloud.report);
    const Quatd turned = rotation_ * Quatd{q[0], q[1], q[2], q[3]};
    q[0] = static_cast<float>(turned.w);
    q[1] = static_cast<float>(turned.x);
    q[2] = static_cast<float>(turned.y);
    q[3] = static_cast<float>(turned.z);
  }
}

// With A = M·R·S the covariance becomes A·Aᵀ, whose axes and sizes are A's singular vectors and
// values: A·Aᵀ itself would square the ratio of a flat disc's axes.
void CloudTransform::reshape(GaussianCloud& cloud) const {
  const Matrix linear = to_eigen(affine_.linear);
  for (size_t i = 0; i < cloud.size(); ++i) {
    float* log_scale = &cloud.log_scale[3 * i];
    float* q = &cloud.rotation[4 * i];
    mend_rotation(q, cloud.report);
    if (!std::all_of(log_scale, log_scale + 3, [](float s) { return std::isfinite(s); })) continue;
    Matrix shape = linear * to_eigen(rotation(normalise(Quatd{q[0], q[1], q[2], q[3]})));
    for (int axis = 0; axis < 3; ++axis)
      shape.col(axis) *= std::exp(std::clamp(double{log_scale[axis]}, -100.0, 100.0));
    const Svd svd(shape, Eigen::ComputeFullU);
    for (int axis = 0; axis < 3; ++axis)
      log_scale[axis] = static_cast<float>(std::log(std::max(svd.singularValues()[axis], 1e-100)));
    const Quatd turned = quaternion_of(without_mirror(from_eigen(svd.matrixU())));
    q[0] = static_cast<float>(turned.w), q[1] = static_cast<float>(turned.x);
    q[2] = static_cast<float>(turned.y), q[3] = static_cast<float>(turned.z);
  }
}

void CloudTransform::apply(GaussianCloud& cloud, const std::array<double, 3>& origin) const {
  move(cloud, origin);
  if (affine_.linear == kIdentity) return;
  if (similar_)
    turn(cloud);
  else
    reshape(cloud);
  const size_t width = static_cast<size_t>(cloud.coefficients()) * 3;
  if (cloud.sh_degree > 0)
    for (size_t i = 0; i < cloud.size(); ++i)
      rotate_sh(sh_, cloud.sh_degree, cloud.sh.data() + i * width);
  cloud.native = of(cloud.native);
}

NativeScale CloudTransform::of(NativeScale native) const {
  native.pixel *= scale_;
  return native;
}

std::array<double, 3> origin_near(const Vec3d& place) {
  std::array<double, 3> origin{0, 0, 0};
  for (int axis = 0; axis < 3; ++axis)
    if (std::fabs(place[axis]) > kOriginReach)
      origin[static_cast<size_t>(axis)] = std::round(place[axis] / kOriginStep) * kOriginStep;
  return origin;
}

}  // namespace voyager
