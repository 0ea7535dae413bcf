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

size_t origin_stride(size_t gaussians) {
  return (gaussians + kSample - 1) / kSample;
}

std::array<double, 3> scene_origin(const std::vector<Vec3d>& sample) {
  if (sample.empty()) return {0, 0, 0};
  Vec3d least{}, most{};
  std::vector<double> sorted(sample.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (size_t i = 0; i < sample.size(); ++i) sorted[i] = sample[i][axis];
    std::sort(sorted.begin(), sorted.end());
    const size_t margin = sorted.size() / 50;
    least[axis] = sorted[margin];
    most[axis] = sorted[sorted.size() - 1 - margin];
  }
  return scene_origin(least, most);
}

std::array<double, 3> scene_origin(const GaussianCloud& cloud) {
  std::vector<Vec3d> sample;
  for (size_t i = 0; i < cloud.size(); i += origin_stride(cloud.size())) {
    const float* p = &cloud.position[3 * i];
    sample.push_back({double{p[0]} + cloud.origin[0], double{p[1]} + cloud.origin[1],
                      double{p[2]} + cloud.origin[2]});
  }
  return scene_origin(sample);
}

}  // namespace voyager
