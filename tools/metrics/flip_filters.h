#pragma once
// The filters of FLIP (flip.h). All are sums of products of one along rows and one along columns.
#include <array>

#include "tools/metrics/plane.h"

namespace voyager::tools {

// Each sums to 1, or its positive weights to 1 and the negative ones to -1.
struct FlipFilters {
  // What is left of detail that eyes do not resolve, in Yy, Cx and Cz: Gaussians, of Cz two.
  Kernel light, red_green;
  std::array<Kernel, 2> blue_yellow;
  double blue_yellow_share = 0;  // of the first of the two; the second has the rest

  // A Gaussian, and its first and second derivative. Along one axis a derivative and along the
  // other the Gaussian finds edges, or points.
  Kernel smooth, edge, point;
};

// pixels_per_degree is in [1, 1000].
FlipFilters flip_filters(double pixels_per_degree);

}  // namespace voyager::tools
