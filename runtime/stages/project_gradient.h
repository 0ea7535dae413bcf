#pragma once
// The adjoint of projection (METHOD §5, §12): from how a loss changes with a splat to how it
// changes with the Gaussian. The formulas are projection's own, called with dual numbers.
#include "runtime/math/dual.h"
#include "runtime/stages/interpolate.h"
#include "runtime/stages/project.h"

namespace voyager {

// Sums over the pixels that a splat is blended into. With g the change of the loss with ln α of a
// pixel, and p, q the pixel's place in the conic's axes (projection.h):
template <class T>
struct SplatSums {
  T g, gp, gq, gpp, gpq, gqq;
  Vec3<T> colour;  // the change of the loss with the splat's colour
};

// The change of the loss with a drawn Gaussian. scale is linear, without the footprint; rotation
// is that of a quaternion of any length, at the unit one.
template <class T>
struct GaussianGradient {
  Vec3<T> mean, scale;
  Quat<T> rotation;
  T log_opacity;
};

namespace detail {

inline constexpr int kShapeInputs = 10;  // mean, scale, rotation

// A splat without its colour. log_kept: what the pixel filter leaves of its peak, in natural
// logarithms.
template <class S>
struct SplatShape {
  S x, y;
  Conic<S> conic;
  S log_kept;
};

template <class S, class T>
VOYAGER_HD ViewProjection<S> with_numbers(const ViewProjection<T>& v) {
  ViewProjection<S> result;
  for (int i = 0; i < 3; ++i)
    result.world_to_view.row[i] = {S(v.world_to_view.row[i].x), S(v.world_to_view.row[i].y),
                                   S(v.world_to_view.row[i].z)};
  result.fx = S(v.fx), result.fy = S(v.fy), result.cx = S(v.cx), result.cy = S(v.cy);
  result.x_low = S(v.x_low), result.x_high = S(v.x_high);
  result.y_low = S(v.y_low), result.y_high = S(v.y_high);
  return result;
}

// relative: the mean from the eye, world axes. scale: without the footprint.
template <class S>
VOYAGER_HD SplatShape<S> splat_shape(const ViewProjection<S>& view, const PixelFilter<S>& filter,
                                     S half, const Vec3<S>& relative, const Vec3<S>& scale,
                                     const Quat<S>& unit) {
  using std::log;
  const Vec3<S> at = view.world_to_view * relative;
  const ImageCovariance<S> covariance = image_covariance(
      image_jacobian(view, at), unit, widened(scale, filter.footprint), filter.low_pass);
  return {view.fx * (at.x / at.z) + view.cx, view.fy * (at.y / at.z) + view.cy,
          conic(covariance, half), filter.compensated ? S(0.5f) * log(covariance.kept) : S(0)};
}

// Of unit length. The general one (vec.h) guards against what no unit quaternion is near to.
template <class S>
VOYAGER_HD Quat<S> near_unit(const Quat<S>& q) {
  using std::sqrt;
  const S length = sqrt(((q.w * q.w + q.x * q.x) + q.y * q.y) + q.z * q.z);
  return {q.w / length, q.x / length, q.y / length, q.z / length};
}

}  // namespace detail

// relative: the mean from the eye, world axes. shape: as interpolated, without the footprint.
// log_scale: of the conic (ProjectParams).
template <class T>
VOYAGER_HD GaussianGradient<T> shape_gradient(const ViewProjection<T>& view,
                                              const PixelFilter<T>& filter, T log_scale,
                                              const Vec3<T>& relative, const Shape<T>& shape,
                                              const SplatSums<T>& sums) {
  using S = Dual<T, detail::kShapeInputs>;
  const Vec3<S> mean{S(relative.x, 0), S(relative.y, 1), S(relative.z, 2)};
  const Vec3<S> scale{S(shape.scale.x, 3), S(shape.scale.y, 4), S(shape.scale.z, 5)};
  const Quat<S> rotation{S(shape.rotation.w, 6), S(shape.rotation.x, 7), S(shape.rotation.y, 8),
                         S(shape.rotation.z, 9)};
  const detail::SplatShape<S> splat = detail::splat_shape(
      detail::with_numbers<S>(view),
      PixelFilter<S>{S(filter.low_pass), S(filter.footprint), filter.compensated},
      S(T(0.5) * log_scale), mean, scale, detail::near_unit(rotation));
  // ln α = log o - (p² + q²) / log_scale, with p = dx·p_x and q = (dy - skew·dx)·q_y.
  const T twice = T(2) / log_scale;
  const T p_x = splat.conic.p_x.value, q_y = splat.conic.q_y.value, skew = splat.conic.skew.value;
  const T by_x = twice * (sums.gp * p_x - sums.gq * (skew * q_y));
  const T by_y = twice * (sums.gq * q_y);
  const T by_p_x = -twice * sums.gpp / p_x;
  const T by_q_y = -twice * sums.gqq / q_y;
  const T by_skew = twice * sums.gpq * (q_y / p_x);
  T by[detail::kShapeInputs];
  for (int i = 0; i < detail::kShapeInputs; ++i)
    by[i] = (by_x * splat.x.by[i] + by_y * splat.y.by[i]) +
            (by_p_x * splat.conic.p_x.by[i] + by_q_y * splat.conic.q_y.by[i]) +
            (by_skew * splat.conic.skew.by[i] + sums.g * splat.log_kept.by[i]);
  return {{by[0], by[1], by[2]}, {by[3], by[4], by[5]}, {by[6], by[7], by[8], by[9]}, sums.g};
}

// The pixel filter with an item's own footprint.
template <class Arrays>
VOYAGER_HD PixelFilter<float> filter_of(const ProjectParams& params, const Arrays& arrays,
                                        const DrawItem& item) {
  PixelFilter<float> filter = params.filter;
  filter.footprint = interpolated_footprint(arrays, item, filter.footprint);
  return filter;
}

// The change of the loss with each coefficient, as into(k, channel, change), and with the mean
// through the direction, which is returned. relative: the mean from the eye. colour: the splat's.
template <class T, class Sh, class Into>
VOYAGER_HD Vec3<T> colour_gradient(int degree, const Vec3<T>& relative, const Vec3<T>& colour,
                                   const Vec3<T>& by_colour, const Sh& sh, const Into& into) {
  using S = Dual<T, 3>;
  using std::sqrt;
  const Vec3<S> d{S(relative.x, 0), S(relative.y, 1), S(relative.z, 2)};
  const S length = sqrt(dot(d, d));
  S basis[16];
  sh_basis(degree, Vec3<S>{d.x / length, d.y / length, d.z / length}, basis);
  // Where a colour was cut off at 0 nothing changes it.
  Vec3<T> by = by_colour;
  for (int channel = 0; channel < 3; ++channel)
    if (!(colour[channel] > T(0))) by[channel] = T(0);
  Vec3<T> by_mean{T(0), T(0), T(0)};
  const int count = sh_coefficients(degree);
  for (int k = 0; k < count; ++k) {
    T slope = T(0);
    for (int channel = 0; channel < 3; ++channel) {
      slope += by[channel] * T(sh(k, channel));
      into(k, channel, by[channel] * basis[k].value);
    }
    for (int i = 0; i < 3; ++i) by_mean[i] += slope * basis[k].by[i];
  }
  return by_mean;
}

}  // namespace voyager
