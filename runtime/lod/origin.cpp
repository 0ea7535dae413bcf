#include <algorithm>
#include <cmath>

#include "runtime/lod/build.h"

namespace voyager {
namespace {

constexpr size_t kSample = 1024;

}  // namespace

std::array<double, 3> scene_origin(const Vec3d& bounds_min, const Vec3d& bounds_max) {
  std::array<double, 3> origin{0, 0, 0};
  for (int axis = 0; axis < 3; ++axis) {
    const double least = bounds_min[axis], most = bounds_max[axis];
    if (std::max(std::fabs(least), std::fabs(most)) > kOriginReach)
      origin[static_cast<size_t>(axis)] =
          kOriginStep * std::round((0.5 * least + 0.5 * most) / kOriginStep);
  }
  return origin;
}

std::array<double, 3> scene_origin(const GaussianCloud& cloud) {
  if (cloud.size() == 0) return {0, 0, 0};
  const size_t stride = (cloud.size() + kSample - 1) / kSample;
  Vec3d least{}, most{};
  std::vector<double> sample;
  for (int axis = 0; axis < 3; ++axis) {
    const size_t a = static_cast<size_t>(axis);
    sample.clear();
    for (size_t i = 0; i < cloud.size(); i += stride)
      sample.push_back(double{cloud.position[3 * i + a]} + cloud.origin[a]);
    std::sort(sample.begin(), sample.end());
    const size_t margin = sample.size() / 50;
    least[axis] = sample[margin];
    most[axis] = sample[sample.size() - 1 - margin];
  }
  return scene_origin(least, most);
}

}  // namespace voyager
