#include <algorithm>
#include <cmath>

#include "runtime/lod/build.h"

namespace voyager {
namespace {

constexpr double kReach = 16000.0;  // metres; binary32 steps by a millimetre there
constexpr double kStep = 1024.0;    // metres; exact to subtract from any coordinate nearby
constexpr size_t kSample = 1024;

}  // namespace

std::array<double, 3> scene_origin(const Vec3d& bounds_min, const Vec3d& bounds_max) {
  std::array<double, 3> origin{0, 0, 0};
  for (int axis = 0; axis < 3; ++axis) {
    const double least = bounds_min[axis], most = bounds_max[axis];
    if (std::max(std::fabs(least), std::fabs(most)) > kReach)
      origin[static_cast<size_t>(axis)] = kStep * std::round((0.5 * least + 0.5 * most) / kStep);
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
