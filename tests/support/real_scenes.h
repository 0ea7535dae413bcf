#pragma once
// Scenes from files, and where to look at them from.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/frame/scene.h"
#include "runtime/scene/import/importer.h"

namespace voyager::test {

inline GaussianCloud import_file(const std::string& path) {
  const auto source = open_file_source(path);
  return import_gaussians(*read_source(*source));
}

// The middle 80 % of a scene's means, along each axis.
struct Middle {
  Vec3d centre;
  double reach;  // the diagonal, metres
};

inline Middle middle_of(const Scene& scene) {
  Vec3d low, high;
  for (int k = 0; k < 3; ++k) {
    std::vector<float> values;
    for (const Gaussian& g : scene.gaussians) values.push_back(g.mean[k]);
    std::sort(values.begin(), values.end());
    low[k] = double{values[values.size() / 10]} + scene.origin[k];
    high[k] = double{values[values.size() * 9 / 10]} + scene.origin[k];
  }
  const Vec3d size = high - low;
  return {0.5 * (low + high), std::sqrt(dot(size, size))};
}

}  // namespace voyager::test
