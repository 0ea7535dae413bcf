#pragma once
// METHOD §5–7 and §12 as a stage: one Gaussian to one splat, or to nothing.
#include "runtime/math/alpha.h"
#include "runtime/math/clip_box.h"
#include "runtime/math/projection.h"
#include "runtime/math/sort_key.h"
#include "runtime/stages/interpolate.h"

namespace voyager {

struct ProjectParams {
  Vec3d origin, eye;           // the scene's; in the scene's coordinates
  ViewProjection<float> view;  // view.world_to_view.row[2] is the view axis of the sort key
  PixelFilter<float> filter;   // its footprint is the largest of the scene
  float near_z;
  float depth_scale;    // of the sort key
  float width, height;  // pixels
  float half;           // ½, or ½·log2(e) for a base-2 exponential
  float log_scale;      // what turns natural logarithms into the conic's: 1 or log2(e)
  float log_threshold;  // log α*, natural
  // The instance's. Who draws an item asks is_inside() first: it needs no more than the mean.
  float opacity, log_opacity;  // natural
  ClipBox<float> clip;         // scene-local
};

// A Gaussian in the image.
struct Splat {
  float x, y;  // centre, pixels
  Conic<float> conic;
  float rho_min;               // in the conic's logarithms
  float opacity, log_opacity;  // natural
  Vec3f colour;
  float depth;                    // the sort key, metres
  float t, inverse_k;             // METHOD §4; t = 1 needs no sibling correction
  float half_width, half_height;  // of a box that holds the support, pixels
};

// How far the support of ρ as computed in binary32 can reach beyond that of the
// real ρ, as a factor on the radius. With ε = 2⁻²⁴: dx and dy carry ε each; p
// one more; the fma of q adds ε·(|dy| + |skew·dx|) ≤ ε·(|t| + 2|skew·dx|) before
// it is scaled; and |dx| ≤ R/p_x on the support. The sum of squares adds 2ε, a row
// found from the one above it ε. 16ε covers what is proportional to R,
// 4ε·q_y·|skew|/p_x the needles; both are doubled for the arithmetic that uses this.
VOYAGER_HD Rounded support_growth(const Conic<float>& c, const Divisor& p_x) {
  constexpr float epsilon = 1.0f / 16777216.0f;
  return Rounded(1.0f) +
         Rounded(epsilon) *
             (Rounded(32.0f) + p_x.quotient(Rounded(8.0f * std::fabs(c.skew)) * Rounded(c.q_y)));
}

// Of ρ itself, absolutely, where it is found as log α - log o (3ε·|log o| + 8ε): where o is
// far above α* the growth covers it, and just above α* this does, 25ε being 1.5e-6.
inline constexpr float kRhoMargin = 4e-6f;

// The radius in (p, q) of the grown support.
VOYAGER_HD Rounded support_radius(const Conic<float>& conic, const Divisor& p_x, float rho_min) {
  return sqrt(Rounded(kRhoMargin) - Rounded(rho_min)) * support_growth(conic, p_x);
}

// The grown support, ready to be cut into strips: dx = along·dy ± across·√(1 - (dy/reach_y)²).
// A reach beyond 1e19 pixels overflows to infinity.
struct SupportEllipse {
  float x, y, reach_x, reach_y, along, across, top;  // top: dy at the right-most point
};

// Exactly the same wherever it is compiled: a device counts a splat's tiles in one kernel
// and lists them in another.
VOYAGER_HD SupportEllipse support_ellipse(float x, float y, const Conic<float>& conic,
                                          float rho_min) {
  const Rounded outwards = 1.000002f;
  const Divisor p_x(conic.p_x);
  const Rounded radius = outwards * support_radius(conic, p_x, rho_min);
  const Rounded width = p_x.quotient(radius);  // half-width
  const Rounded tilt = width * conic.skew, thickness = radius / conic.q_y;
  const Rounded height = sqrt(tilt * tilt + thickness * thickness);
  const Divisor of_height(height);
  return {x,
          y,
          width.value,
          height.value,
          (of_height.quotient(width) * of_height.quotient(tilt)).value,
          (width * of_height.quotient(thickness)).value,
          tilt.value};
}
VOYAGER_HD SupportEllipse support_ellipse(const Splat& s) {
  return support_ellipse(s.x, s.y, s.conic, s.rho_min);
}

namespace detail {

VOYAGER_HD bool misses(float centre, float reach, float size) {
  return centre + reach < 0.0f || centre - reach > size;
}

VOYAGER_HD float largest(const Vec3f& v) {
  const float m = v.x > v.y ? v.x : v.y;
  return v.z > m ? v.z : m;
}

// What is centred there misses the image by no reach: whoever is, needs no bound on the support.
VOYAGER_HD bool in_image(const ProjectParams& params, float x, float y) {
  return x >= 0.0f && x <= params.width && y >= 0.0f && y <= params.height;
}

// A bound on the support before the covariance is known: no axis is longer than the
// largest scale, footprint included. radius: of the support, in standard deviations. 1.01
// covers the rounding of the sums behind it.
VOYAGER_HD bool surely_outside(const ProjectParams& params, const ImageJacobian<float>& j,
                               float variance, float radius, float x, float y) {
  const float low = params.filter.low_pass;
  radius *= 1.01f;
  return misses(x, radius * std::sqrt(variance * dot(j.x, j.x) + low), params.width) ||
         misses(y, radius * std::sqrt(variance * dot(j.y, j.y) + low), params.height);
}

// The mean in view space.
VOYAGER_HD Vec3f to_view(const ProjectParams& params, const Vec3f& relative) {
  const Mat3f& w = params.view.world_to_view;
  return {dot(w.row[0], relative), dot(w.row[1], relative), view_depth(relative, w.row[2])};
}

VOYAGER_HD float image_x(const ProjectParams& params, const Vec3f& view) {
  return params.view.fx * (view.x / view.z) + params.view.cx;
}
VOYAGER_HD float image_y(const ProjectParams& params, const Vec3f& view) {
  return params.view.fy * (view.y / view.z) + params.view.cy;
}

}  // namespace detail

// The radius of the support, in standard deviations, where nothing is lost to the low-pass.
VOYAGER_HD float support_bound(float log_opacity, float log_threshold) {
  const float rho = rho_min(log_opacity, log_threshold);
  return std::sqrt(2.0f * std::fmax(kRhoMargin - rho, 0.0f));
}

// Whether a Gaussian may reach the image, from its mean and bounds on its stored largest scale
// and on the radius of its support (standard deviations): what fails here, project()
// drops too.
VOYAGER_HD bool may_reach(const ProjectParams& params, const Vec3f& mean, float max_scale,
                          float radius) {
  const Vec3f view = detail::to_view(params, camera_relative(mean, params.origin, params.eye));
  if (!(view.z > params.near_z)) return false;
  return !detail::surely_outside(params, image_jacobian(params.view, view),
                                 max_scale * max_scale + params.filter.footprint, radius,
                                 detail::image_x(params, view), detail::image_y(params, view));
}

// What a Gaussian's splats in the images of several eyes have in common.
struct DrawnGaussian {
  Vec3f mean;
  Shape<float> shape;  // its scale with the footprint
  float rho_min;       // in natural logarithms; of a splat that loses nothing to the low-pass
};

// False where it is under the α threshold everywhere (METHOD §7a). params: of any eye.
template <class Arrays>
VOYAGER_HD bool read_gaussian(const ProjectParams& params, const Arrays& arrays,
                              const DrawItem& item, DrawnGaussian& drawn) {
  drawn.mean = interpolated_mean(arrays, item);
  drawn.shape = interpolated_shape<float>(arrays, item);
  fade(drawn.shape, params.opacity, params.log_opacity);
  if (params.filter.footprint > 0.0f)
    drawn.shape.scale =
        widened(drawn.shape.scale, interpolated_footprint(arrays, item, params.filter.footprint));
  drawn.rho_min = rho_min(drawn.shape.log_opacity, params.log_threshold);
  return drawn.rho_min <= 0.0f;
}

VOYAGER_HD bool before_near_plane(const ProjectParams& params, const Vec3f& mean) {
  return view_depth(camera_relative(mean, params.origin, params.eye),
                    params.view.world_to_view.row[2]) > params.near_z;
}

// All of the splat but its colour. False where nothing of it can reach the image: behind the
// near plane, outside the image, or where the low-pass leaves no α above the threshold.
// relative: where its mean is from the eye, in world axes.
VOYAGER_HD bool project_shape(const ProjectParams& params, const DrawItem& item,
                              const DrawnGaussian& drawn, Splat& splat, Vec3f& relative) {
  relative = camera_relative(drawn.mean, params.origin, params.eye);
  const Vec3f view = detail::to_view(params, relative);
  if (!(view.z > params.near_z)) return false;

  splat.x = detail::image_x(params, view);
  splat.y = detail::image_y(params, view);
  const Shape<float>& shape = drawn.shape;
  const ImageJacobian<float> jacobian = image_jacobian(params.view, view);
  const float longest = detail::largest(shape.scale);
  if (!detail::in_image(params, splat.x, splat.y) &&
      detail::surely_outside(params, jacobian, longest * longest,
                             std::sqrt(2.0f * (kRhoMargin - drawn.rho_min)), splat.x, splat.y))
    return false;

  const ImageCovariance<float> covariance =
      image_covariance(jacobian, shape.rotation, shape.scale, params.filter.low_pass);
  splat.opacity = shape.opacity;
  splat.log_opacity = shape.log_opacity;
  float least = drawn.rho_min;
  if (params.filter.compensated) {
    splat.opacity *= std::sqrt(covariance.kept);
    splat.log_opacity += 0.5f * std::log(covariance.kept);
    least = rho_min(splat.log_opacity, params.log_threshold);
    if (!(least <= 0.0f)) return false;
  }
  splat.conic = conic(covariance, params.half);
  splat.rho_min = least * params.log_scale;
  const SupportEllipse support = support_ellipse(splat);
  splat.half_width = support.reach_x;
  splat.half_height = support.reach_y;
  splat.depth = sort_depth(view.z, params.depth_scale);
  splat.t = item.t;
  splat.inverse_k = item.inverse_k;
  return std::fabs(splat.x) < 1e30f && std::fabs(splat.y) < 1e30f && splat.half_width < 1e19f &&
         splat.half_height < 1e19f && !detail::misses(splat.x, splat.half_width, params.width) &&
         !detail::misses(splat.y, splat.half_height, params.height);
}

// SH are evaluated for each eye: what an eye sees does not depend on the other.
template <class Arrays>
VOYAGER_HD bool project(const ProjectParams& params, const Arrays& arrays, const DrawItem& item,
                        const DrawnGaussian& drawn, Splat& splat) {
  Vec3f d;
  if (!project_shape(params, item, drawn, splat, d)) return false;
  splat.colour = interpolated_colour(arrays, item, (1.0f / std::sqrt(dot(d, d))) * d);
  return true;
}

}  // namespace voyager
