#pragma once
// Whether any Gaussian of a box may reach the image: what many of them are left out by at once,
// before their own attributes are read.
#include "runtime/stages/project.h"

namespace voyager {

// Of some Gaussians: the box of their means, scene-local metres, and the greatest of their largest
// scales (metres) and of the radii of their supports (standard deviations). Without any: a radius
// of 0, which reaches nothing.
struct MeanBounds {
  Vec3f least;
  float scale;
  Vec3f greatest;
  float radius;
};
static_assert(sizeof(MeanBounds) == 32);

namespace detail {

// On one axis of the image: `at` and `half` are the box in view space, z the depth.
struct BoxSpan {
  float at, half, z, half_z;
};

// Whether focal·(at + reach)/z + centre + low < 0 for all of the box in front of the eye. Times z,
// that is a plane. 1e-4 is far more than what its terms round by.
VOYAGER_HD bool box_is_below(const BoxSpan& box, float focal, float centre, float reach,
                             float low) {
  const float depth = centre + low;
  const float most =
      focal * (box.at + box.half + reach) + (depth * box.z + std::fabs(depth) * box.half_z);
  const float terms = focal * (std::fabs(box.at) + box.half + reach) +
                      std::fabs(depth) * (std::fabs(box.z) + box.half_z);
  return most < -1e-4f * terms;
}

// Both sides of the image. slope: the largest that the Jacobian has on the axis.
VOYAGER_HD bool box_misses(const BoxSpan& box, float focal, float centre, float size, float slope,
                           float reach, float low) {
  const float grown = reach * std::sqrt(1.0f + slope * slope);
  const BoxSpan mirrored{-box.at, box.half, box.z, box.half_z};
  return box_is_below(box, focal, centre, grown, low) ||
         box_is_below(mirrored, focal, size - centre, grown, low);
}

VOYAGER_HD float largest_slope(float low, float high) {
  return std::fmax(std::fabs(low), std::fabs(high));
}

}  // namespace detail

// A box of means in view space, and what lies around each of them.
struct BoxInView {
  Vec3f centre, half;
  float low;    // pixels that the pixel filter adds, and one to spare
  float reach;  // metres that the support reaches
};

VOYAGER_HD BoxInView box_in_view(const ProjectParams& params, const MeanBounds& bounds) {
  const auto middle = [](float a, float b) { return 0.5f * a + 0.5f * b; };
  const auto half = [](float a, float b) { return 0.5f * b - 0.5f * a; };
  const Vec3f &a = bounds.least, &b = bounds.greatest;
  const Vec3f centre{middle(a.x, b.x), middle(a.y, b.y), middle(a.z, b.z)};
  const Vec3f sides{half(a.x, b.x), half(a.y, b.y), half(a.z, b.z)};
  const Vec3f relative = camera_relative(centre, params.origin, params.eye);
  // What the centre and the sides are rounded by.
  const float rounded =
      1e-6f * (std::fabs(relative.x) + std::fabs(relative.y) + std::fabs(relative.z)) +
      1e-6f * (std::fabs(centre.x) + std::fabs(centre.y) + std::fabs(centre.z));
  float along[3];
  for (int i = 0; i < 3; ++i) {
    const Vec3f& axis = params.view.world_to_view.row[i];
    along[i] = 1.0001f * (std::fabs(axis.x) * sides.x + std::fabs(axis.y) * sides.y +
                          std::fabs(axis.z) * sides.z) +
               rounded;
  }
  const float radius = 1.01f * bounds.radius;
  return {detail::to_view(params, relative),
          {along[0], along[1], along[2]},
          radius * std::sqrt(params.filter.low_pass) + 1.0f,
          radius * std::sqrt(bounds.scale * bounds.scale + params.filter.footprint)};
}

// False only where project() gives no splat for any Gaussian whose mean is in the box, and whose
// scale and support are no larger than its bounds: in front of no near plane, or outside the image
// by its bound on the support, which is the sum of what the scale and what the pixel filter add.
// Numbers that overflow pass.
VOYAGER_HD bool may_reach(const ProjectParams& params, const MeanBounds& bounds) {
  if (!(bounds.radius > 0.0f)) return false;
  const BoxInView box = box_in_view(params, bounds);
  if (box.centre.z + box.half.z <= params.near_z) return false;
  const ViewProjection<float>& v = params.view;
  return !detail::box_misses({box.centre.x, box.half.x, box.centre.z, box.half.z}, v.fx, v.cx,
                             params.width, detail::largest_slope(v.x_low, v.x_high), box.reach,
                             box.low) &&
         !detail::box_misses({box.centre.y, box.half.y, box.centre.z, box.half.z}, v.fy, v.cy,
                             params.height, detail::largest_slope(v.y_low, v.y_high), box.reach,
                             box.low);
}

// Where in the image the splats of a box may lie, pixels from the top left corner, and the least z
// (metres) that one of them may have.
struct ImageBounds {
  float left, right, top, bottom;
  float nearest;
};

namespace detail {

// Of (at ± (half + reach))/z·focal + centre over the box's depths.
VOYAGER_HD void image_span(const BoxSpan& box, float focal, float centre, float slope, float reach,
                           float low, float& least, float& most) {
  const float grown = box.half + reach * std::sqrt(1.0f + slope * slope);
  const float nearest = box.z - box.half_z, farthest = box.z + box.half_z;
  const float a = box.at - grown, b = box.at + grown;
  const float from = focal * (a / (a < 0.0f ? nearest : farthest));
  const float to = focal * (b / (b > 0.0f ? nearest : farthest));
  least = from + centre - low - 1e-4f * (std::fabs(from) + std::fabs(centre));
  most = to + centre + low + 1e-4f * (std::fabs(to) + std::fabs(centre));
}

}  // namespace detail

// False where nothing can be said: some of the box may be at the near plane or behind it.
VOYAGER_HD bool image_bounds(const ProjectParams& params, const MeanBounds& bounds,
                             ImageBounds& image) {
  const BoxInView box = box_in_view(params, bounds);
  image.nearest = box.centre.z - box.half.z;
  if (!(image.nearest > params.near_z)) return false;
  const ViewProjection<float>& v = params.view;
  detail::image_span({box.centre.x, box.half.x, box.centre.z, box.half.z}, v.fx, v.cx,
                     detail::largest_slope(v.x_low, v.x_high), box.reach, box.low, image.left,
                     image.right);
  detail::image_span({box.centre.y, box.half.y, box.centre.z, box.half.z}, v.fy, v.cy,
                     detail::largest_slope(v.y_low, v.y_high), box.reach, box.low, image.top,
                     image.bottom);
  return true;
}

}  // namespace voyager
