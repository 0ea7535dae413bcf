#pragma once
// METHOD §5–7 as a stage: one Gaussian to one splat, or to nothing.
#include "runtime/math/alpha.h"
#include "runtime/math/projection.h"
#include "runtime/math/sort_key.h"
#include "runtime/stages/interpolate.h"

namespace voyager {

struct ProjectParams {
  GaussianArrays arrays;
  Vec3d origin, eye;           // the scene's; world
  ViewProjection<float> view;  // view.world_to_view.row[2] is the view axis of the sort key
  float near_z;
  float width, height;  // pixels
  float half;           // ½, or ½·log2(e) for a base-2 exponential
  float log_scale;      // what turns natural logarithms into the conic's: 1 or log2(e)
};

// A Gaussian in the image.
struct Splat {
  float x, y;  // centre, pixels
  Conic<float> conic;
  float rho_min;               // in the conic's logarithms
  float opacity, log_opacity;  // natural
  Vec3f colour;
  float depth;                    // the sort key z, metres
  float t, inverse_k;             // METHOD §4; t = 1 needs no sibling correction
  float half_width, half_height;  // of a box that holds the support, pixels
};

// How far the support of ρ as computed in binary32 can reach beyond that of the
// real ρ, as a factor on the radius. With ε = 2⁻²⁴: dx and dy carry ε each; p
// one more; the fma of q adds ε·(|dy| + |skew·dx|) ≤ ε·(|t| + 2|skew·dx|) before
// it is scaled; and |dx| ≤ R/p_x on the support. The sum of squares adds 2ε.
// 16ε covers what is proportional to R, 4ε·q_y·|skew|/p_x the needles.
VOYAGER_HD double support_growth(const Conic<float>& c) {
  const double epsilon = 1.0 / 16777216.0;
  return 1.0 +
         epsilon * (16.0 + 4.0 * static_cast<double>(c.q_y) *
                               std::fabs(static_cast<double>(c.skew)) / static_cast<double>(c.p_x));
}

// The radius in (p, q) of the grown support.
VOYAGER_HD double support_radius(const Splat& s) {
  return std::sqrt(-static_cast<double>(s.rho_min)) * support_growth(s.conic);
}

// The grown support, ready to be cut into strips: dx = along·dy ± across·√(1 - (dy/reach_y)²).
struct SupportEllipse {
  double x, y, reach_x, reach_y, along, across, top;  // top: dy at the right-most point
};

VOYAGER_HD SupportEllipse support_ellipse(const Splat& s) {
  const double radius = support_radius(s);
  const double width = radius / static_cast<double>(s.conic.p_x);  // half-width
  const double tilt = static_cast<double>(s.conic.skew) * width;
  const double thickness = radius / static_cast<double>(s.conic.q_y);
  const double height = std::sqrt(tilt * tilt + thickness * thickness);
  return {static_cast<double>(s.x),         static_cast<double>(s.y),   width, height,
          width * tilt / (height * height), width * thickness / height, tilt};
}

namespace detail {

VOYAGER_HD bool misses(float centre, float reach, float size) {
  return centre + reach < 0.0f || centre - reach > size;
}

// A bound on the support before the covariance is known: no axis is longer
// than the largest scale. 1.01 covers the rounding of the sums behind it.
VOYAGER_HD bool surely_outside(const ProjectParams& params, const ImageJacobian<float>& j,
                               const Shape<float>& shape, float rho, float x, float y) {
  float s = shape.scale.x > shape.scale.y ? shape.scale.x : shape.scale.y;
  s = shape.scale.z > s ? shape.scale.z : s;
  const float radius = 1.01f * std::sqrt(-2.0f * rho);
  const float low = static_cast<float>(kLowPass);
  return misses(x, radius * std::sqrt(s * s * dot(j.x, j.x) + low), params.width) ||
         misses(y, radius * std::sqrt(s * s * dot(j.y, j.y) + low), params.height);
}

}  // namespace detail

// False where nothing of it can reach the image: behind the near plane, under
// the α threshold everywhere (METHOD §7a), or outside the image.
VOYAGER_HD bool project(const ProjectParams& params, const DrawItem& item, Splat& splat) {
  const Vec3f d =
      camera_relative(interpolated_mean(params.arrays, item), params.origin, params.eye);
  const Mat3f& w = params.view.world_to_view;
  const float depth = view_depth(d, w.row[2]);
  if (!(depth > params.near_z)) return false;

  const Shape<float> shape = interpolated_shape<float>(params.arrays, item);
  const float rho = rho_min(shape.log_opacity);
  if (!(rho <= 0.0f)) return false;

  const Vec3f view{dot(w.row[0], d), dot(w.row[1], d), depth};
  splat.x = params.view.fx * (view.x / view.z) + params.view.cx;
  splat.y = params.view.fy * (view.y / view.z) + params.view.cy;
  const ImageJacobian<float> jacobian = image_jacobian(params.view, view);
  if (detail::surely_outside(params, jacobian, shape, rho, splat.x, splat.y)) return false;

  const ImageCovariance<float> covariance = image_covariance(jacobian, shape.rotation, shape.scale);
  splat.conic = conic(covariance, params.half);
  splat.rho_min = rho * params.log_scale;
  const SupportEllipse support = support_ellipse(splat);
  splat.half_width = static_cast<float>(support.reach_x * 1.000001);  // rounded outwards
  splat.half_height = static_cast<float>(support.reach_y * 1.000001);
  if (!(std::fabs(splat.x) < 1e30f) || !(std::fabs(splat.y) < 1e30f) ||
      !(splat.half_width < 1e30f) || !(splat.half_height < 1e30f) ||
      detail::misses(splat.x, splat.half_width, params.width) ||
      detail::misses(splat.y, splat.half_height, params.height))
    return false;

  const float length = std::sqrt(dot(d, d));
  splat.colour = interpolated_colour(params.arrays, item, (1.0f / length) * d);
  splat.opacity = shape.opacity;
  splat.log_opacity = shape.log_opacity;
  splat.depth = depth;
  splat.t = item.t;
  splat.inverse_k = item.inverse_k;
  return true;
}

}  // namespace voyager
