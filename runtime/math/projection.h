#pragma once
// METHOD §5, §12: a Gaussian's mean and covariance in the image. T is float in the
// backends and double in the reference.
#include <cmath>

#include "runtime/math/pixel_filter.h"
#include "runtime/math/vec.h"

namespace voyager {

inline constexpr double kFrustumGrowth = 0.3;  // of the frustum's half-width, on each side

// What projection needs of a camera, resolved once a frame.
template <class T>
struct ViewProjection {
  Mat3<T> world_to_view;           // rows: right, down, forward
  T fx, fy, cx, cy;                // pixels
  T x_low, x_high, y_low, y_high;  // bounds of t_x/t_z and t_y/t_z in the Jacobian
};

template <class T>
ViewProjection<T> view_projection(const Mat3d& world_to_view, double fx, double fy, double cx,
                                  double cy, double width, double height) {
  ViewProjection<T> v;
  for (int i = 0; i < 3; ++i)
    v.world_to_view.row[i] = {static_cast<T>(world_to_view.row[i].x),
                              static_cast<T>(world_to_view.row[i].y),
                              static_cast<T>(world_to_view.row[i].z)};
  const double grow_x = kFrustumGrowth * 0.5 * width / fx,
               grow_y = kFrustumGrowth * 0.5 * height / fy;
  v.fx = static_cast<T>(fx);
  v.fy = static_cast<T>(fy);
  v.cx = static_cast<T>(cx);
  v.cy = static_cast<T>(cy);
  v.x_low = static_cast<T>(-cx / fx - grow_x);
  v.x_high = static_cast<T>((width - cx) / fx + grow_x);
  v.y_low = static_cast<T>(-cy / fy - grow_y);
  v.y_high = static_cast<T>((height - cy) / fy + grow_y);
  return v;
}

// Σ' = [[xx, xy], [xy, yy]] with the low-pass, in pixels². y_given_x is
// det Σ' / xx: the variance along y once x is known. kept is det TTᵀ / det Σ', both as below:
// the square of the share of a splat's peak that the low-pass leaves, in [0, 1].
template <class T>
struct ImageCovariance {
  T xx, xy, yy, y_given_x, kept;
};

// The rows of J W: how the image moves with the mean, in pixels a metre.
template <class T>
struct ImageJacobian {
  Vec3<T> x, y;
};

// view: the mean in view space, z > 0. Its slopes are clamped (METHOD §5).
template <class T>
VOYAGER_HD ImageJacobian<T> image_jacobian(const ViewProjection<T>& v, const Vec3<T>& view) {
  const T inverse_z = T(1) / view.z;
  T x = view.x * inverse_z, y = view.y * inverse_z;
  // One bound at a time, for which a device needs no branch.
  x = x < v.x_low ? v.x_low : x;
  x = x > v.x_high ? v.x_high : x;
  y = y < v.y_low ? v.y_low : y;
  y = y > v.y_high ? v.y_high : y;
  const Mat3<T>& w = v.world_to_view;
  return {(v.fx * inverse_z) * (w.row[0] - x * w.row[2]),
          (v.fy * inverse_z) * (w.row[1] - y * w.row[2])};
}

// With T = J W R diag(s) (2 x 3) the determinant is the sum of T's squared
// minors and positive terms: nothing cancels. The minors are divided by the
// length of T's first row before they are squared, so that nothing overflows.
template <class T>
VOYAGER_HD ImageCovariance<T> image_covariance(const ImageJacobian<T>& j, const Quat<T>& q,
                                               const Vec3<T>& s, T low) {
  const Mat3<T> r = rotation(q);
  T a[3], b[3];
  for (int i = 0; i < 3; ++i) {
    const Vec3<T> column{r.row[0][i], r.row[1][i], r.row[2][i]};
    a[i] = s[i] * dot(j.x, column);
    b[i] = s[i] * dot(j.y, column);
  }
  const T aa = (a[0] * a[0] + a[1] * a[1]) + a[2] * a[2];
  const T bb = (b[0] * b[0] + b[1] * b[1]) + b[2] * b[2];
  const T ab = (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
  const T xx = aa + low;
  using std::sqrt;  // also of what gradients are found with (dual.h)
  const T n = T(1) / sqrt(xx);
  const T m0 = (a[1] * b[2] - a[2] * b[1]) * n, m1 = (a[2] * b[0] - a[0] * b[2]) * n;
  const T m2 = (a[0] * b[1] - a[1] * b[0]) * n;
  const T minors = (m0 * m0 + m1 * m1) + m2 * m2;
  const T y_given_x = minors + low * ((aa + bb) + low) / xx;
  return {xx, ab, bb + low, y_given_x, minors / y_given_x};
}

// ρ = -(p² + q²) with p = dx·p_x and q = (dy - skew·dx)·q_y: never positive.
// The ½ of METHOD §5 and, for a base-2 exponential, log2(e) are folded in.
template <class T>
struct Conic {
  T p_x, skew, q_y;
};

template <class T>
VOYAGER_HD Conic<T> conic(const ImageCovariance<T>& c, T half) {  // half = ½, or ½·log2(e)
  using std::sqrt;
  return {sqrt(half / c.xx), c.xy / c.xx, sqrt(half / c.y_given_x)};
}

}  // namespace voyager
