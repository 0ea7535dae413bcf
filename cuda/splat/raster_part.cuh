#pragma once
// A warp's part of a tile, and which splats it may leave out.
#include "cuda/splat/raster_lane.cuh"

namespace voyager::cuda {

// The centres of the first and the last pixel of a warp's part.
struct Part {
  float x0, x1, y0, y1;
};

// Whether the support may touch the part: the least p² + q² over it is on one of the two
// edges that face the centre.
__device__ inline bool rasterize_touches(const RasterSplat& s, const Part& part,
                                         float log_threshold) {
  const float p_x = s.shape.z, q_y = s.shape.w, skew = s.middle.x;
  const float pp = p_x * p_x, kq = skew * q_y;
  const float x0 = part.x0 - s.shape.x, x1 = part.x1 - s.shape.x;
  const float y0 = part.y0 - s.shape.y, y1 = part.y1 - s.shape.y;
  const float x = fminf(fmaxf(0.0f, x0), x1), y = fminf(fmaxf(0.0f, y0), y1);
  const float p1 = x * p_x, t1 = skew * x;
  const float q1 = (fminf(fmaxf(t1, y0), y1) - t1) * q_y;
  // Where (p, q) is shortest on the row at y. If the divisor underflows, that is anywhere.
  const float nearest = kq * q_y * reciprocal(fmaf(kq, kq, pp)) * y;
  const float along = fminf(fmaxf(nearest, x0), x1);
  const float p2 = along * p_x, q2 = fmaf(-skew, along, y) * q_y;
  // Twice the growth of runtime/stages/project.h: this arithmetic rounds too.
  const float growth = 1.0f + 1.2e-7f * (64.0f + 16.0f * fabsf(kq) * reciprocal(p_x));
  const float radius = (s.middle.y - log_threshold) + 2.0f * kRhoMargin;
  return fminf(fmaf(p1, p1, q1 * q1), fmaf(p2, p2, q2 * q2)) <= radius * (growth * growth);
}

}  // namespace voyager::cuda
