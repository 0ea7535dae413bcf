#pragma once
// Scenes from files, and where to look at them from.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "runtime/frame/scene.h"
#include "runtime/frame/scene_gaussians.h"
#include "tests/support/import_file.h"
#include "tests/support/tree_rules.h"

namespace voyager::test {

// The Gaussians nearest to a place of the world, in their order: as dense as the whole.
inline GaussianCloud nearest(const GaussianCloud& cloud, const Vec3d& place, size_t most) {
  std::vector<std::pair<double, size_t>> by_distance;
  for (size_t i = 0; i < cloud.size(); ++i) {
    const Vec3d to{cloud.position[3 * i] + cloud.origin[0] - place.x,
                   cloud.position[3 * i + 1] + cloud.origin[1] - place.y,
                   cloud.position[3 * i + 2] + cloud.origin[2] - place.z};
    by_distance.emplace_back(dot(to, to), i);
  }
  most = std::min(most, cloud.size());
  std::sort(by_distance.begin(), by_distance.end());
  std::vector<size_t> kept;
  for (size_t i = 0; i < most; ++i) kept.push_back(by_distance[i].second);
  std::sort(kept.begin(), kept.end());
  GaussianCloud near;
  near.sh_degree = cloud.sh_degree, near.origin = cloud.origin;
  near.native = cloud.native, near.left_out_bands = cloud.left_out_bands;
  const auto take = [&](const auto& from, auto& into, size_t each) {
    for (const size_t i : kept)
      into.insert(into.end(), from.begin() + each * i, from.begin() + each * (i + 1));
  };
  take(cloud.position, near.position, 3), take(cloud.log_scale, near.log_scale, 3);
  take(cloud.rotation, near.rotation, 4), take(cloud.opacity, near.opacity, 1);
  take(cloud.sh, near.sh, 3 * static_cast<size_t>(cloud.coefficients()));
  return near;
}

// The district, or the part of it around the cameras of its paths: all of it takes minutes.
inline GaussianCloud district(const std::string& folder) {
  GaussianCloud cloud = import_file(folder + "/district.spz");
  return whole_paths() ? cloud : nearest(cloud, {156, -25, 150}, 50000);
}

// The middle 80 % of a scene's means, along each axis.
struct Middle {
  Vec3d centre;
  double reach;  // the diagonal, metres
};

inline Middle middle_of(const Scene& scene) {
  const GaussianArrays arrays = gaussian_arrays(scene);
  Vec3d low, high;
  for (int k = 0; k < 3; ++k) {
    std::vector<float> values;
    for (uint32_t i = 0; i < gaussian_count(scene); ++i) values.push_back(arrays.mean(i)[k]);
    std::sort(values.begin(), values.end());
    low[k] = double{values[values.size() / 10]} + scene.origin[k];
    high[k] = double{values[values.size() * 9 / 10]} + scene.origin[k];
  }
  const Vec3d size = high - low;
  return {0.5 * (low + high), std::sqrt(dot(size, size))};
}

}  // namespace voyager::test
