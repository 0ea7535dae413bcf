#include "tools/metrics/plane.h"

#include <algorithm>
#include <cassert>

namespace voyager::tools {
namespace {

void add_scaled(const double* from, double weight, size_t count, double* to) {
  for (size_t i = 0; i < count; ++i) to[i] += weight * from[i];
}

}  // namespace

Plane filter_rows(const Plane& plane, const Kernel& kernel) {
  assert(kernel.size() % 2 == 1);
  const size_t width = plane.width, radius = kernel.size() / 2;
  Plane filtered{width, std::vector<double>(plane.values.size())};
  std::vector<double> padded(width + 2 * radius);
  for (size_t start = 0; start < plane.values.size(); start += width) {
    const double* row = &plane.values[start];
    std::fill_n(padded.begin(), radius, row[0]);
    std::copy_n(row, width, &padded[radius]);
    std::fill_n(&padded[radius + width], radius, row[width - 1]);
    for (size_t i = 0; i < kernel.size(); ++i)
      add_scaled(&padded[i], kernel[i], width, &filtered.values[start]);
  }
  return filtered;
}

Plane filter_columns(const Plane& plane, const Kernel& kernel) {
  assert(kernel.size() % 2 == 1);
  const size_t width = plane.width, height = plane.height(), radius = kernel.size() / 2;
  Plane filtered{width, std::vector<double>(plane.values.size())};
  for (size_t y = 0; y < height; ++y)
    for (size_t i = 0; i < kernel.size(); ++i) {
      const size_t from = std::clamp(y + i, radius, radius + height - 1) - radius;
      add_scaled(&plane.values[from * width], kernel[i], width, &filtered.values[y * width]);
    }
  return filtered;
}

Plane filter(const Plane& plane, const Kernel& kernel) {
  return filter_columns(filter_rows(plane, kernel), kernel);
}

}  // namespace voyager::tools
