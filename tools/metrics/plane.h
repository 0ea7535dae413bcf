#pragma once
// One value a pixel, and filters along its rows and columns.
#include <cstddef>
#include <vector>

namespace voyager::tools {

struct Plane {
  size_t width = 0;            // > 0
  std::vector<double> values;  // row by row, whole rows

  size_t height() const { return values.size() / width; }
};

// Weights of neighbours; an odd number, the pixel itself in the middle.
using Kernel = std::vector<double>;

// value(x) = Σ_i kernel(i) · value(x + i), i from −radius to radius. Beyond the border the pixels
// at it are repeated. Sums are in order of i, whatever the machine.
Plane filter_rows(const Plane& plane, const Kernel& kernel);
Plane filter_columns(const Plane& plane, const Kernel& kernel);

// Along both.
Plane filter(const Plane& plane, const Kernel& kernel);

}  // namespace voyager::tools
