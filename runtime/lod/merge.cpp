#include "runtime/lod/merge.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>

#include "runtime/math/sh.h"

namespace voyager {
namespace {

double share(const MergeInput& child, double total, size_t count) {
  return total > 0.0 ? child.weight / total : 1.0 / static_cast<double>(count);
}

// Adds share·(Σ + d dᵀ). The float quaternion is normalised again in double:
// its own rounding would fatten a needle of ratio 1e8 by a thousandfold.
void add_covariance(double share, const Gaussian& g, const Vec3d& d, double* covariance) {
  const Quatd q = normalise(Quatd{g.rotation.w, g.rotation.x, g.rotation.y, g.rotation.z});
  const Mat3d r = rotation(q);
  int k = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      double sum = d[i] * d[j];
      for (int axis = 0; axis < 3; ++axis) {
        const double s = g.scale[axis];
        sum += (r.row[i][axis] * s) * (r.row[j][axis] * s);
      }
      covariance[k++] += share * sum;
    }
  }
}

// Scale and rotation from the eigen-decomposition, degenerate axes regularised.
void set_shape(const double* c, GaussianWords& words) {
  Eigen::Matrix3d covariance;
  covariance << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const double largest = std::sqrt(std::max(solver.eigenvalues()[2], 0.0));
  const double least = std::max(kMinMergedScale, kMinMergedRatio * largest);
  for (int i = 0; i < 3; ++i) {
    const double s = std::sqrt(std::max(solver.eigenvalues()[i], 0.0));
    words.log_scale[i] = static_cast<float>(std::log(std::max(s, least)));
  }
  Eigen::Matrix3d axes = solver.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(0) = -axes.col(0);
  const Eigen::Quaterniond q = Eigen::Quaterniond(axes).normalized();
  words.rotation = {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()),
                    static_cast<float>(q.z())};
}

void merge_sh(std::span<const MergeInput> children, double total, int coefficients, float* out) {
  double sums[3 * sh_coefficients(kMaxShDegree)] = {};
  for (const MergeInput& child : children) {
    const double weight = share(child, total, children.size());
    for (int k = 0; k < 3 * coefficients; ++k) sums[k] += weight * double{child.sh[k]};
  }
  for (int k = 0; k < 3 * coefficients; ++k) out[k] = static_cast<float>(sums[k]);
}

}  // namespace

double merge_weight(const Gaussian& gaussian) {
  const Vec3f& s = gaussian.scale;
  return double{gaussian.opacity} * surface(Vec3d{s.x, s.y, s.z});
}

Moments moments(std::span<const MergeInput> children) {
  Moments m{};
  for (const MergeInput& child : children) m.weight += child.weight;
  for (const MergeInput& child : children) {
    const Vec3f& mean = child.gaussian.mean;
    m.mean = m.mean + share(child, m.weight, children.size()) * Vec3d{mean.x, mean.y, mean.z};
  }
  for (const MergeInput& child : children) {
    const Vec3f& mean = child.gaussian.mean;
    add_covariance(share(child, m.weight, children.size()), child.gaussian,
                   Vec3d{mean.x, mean.y, mean.z} - m.mean, m.covariance);
  }
  return m;
}

Merged merge(std::span<const MergeInput> children, int coefficients, float* sh_out) {
  const Moments m = moments(children);
  Merged merged;
  GaussianWords& words = merged.words;
  words.mean = {static_cast<float>(m.mean.x), static_cast<float>(m.mean.y),
                static_cast<float>(m.mean.z)};
  set_shape(m.covariance, words);
  words.opacity = 0.0f;
  const Vec3f s = activate(words, false).scale;
  words.opacity = static_cast<float>(m.weight / surface(Vec3d{s.x, s.y, s.z}));
  merge_sh(children, m.weight, coefficients, sh_out);
  return merged;
}

}  // namespace voyager
