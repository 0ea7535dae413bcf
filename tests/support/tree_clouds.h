#pragma once
// Clouds that a tree must survive: random ones of every size, and the degenerate.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "runtime/lod/build.h"
#include "runtime/scene/sanitise.h"
#include "tests/support/test_support.h"
#include "tests/support/tree_rules.h"

namespace voyager::test {

struct NamedCloud {
  std::string name;
  GaussianCloud cloud;
};

// As random_cloud(), but small: what is seen of them is soon found out.
inline GaussianCloud specks(size_t count, uint32_t seed, int sh_degree) {
  GaussianCloud cloud = random_cloud(count, seed, sh_degree);
  for (float& s : cloud.log_scale) s -= 4;
  return cloud;
}

// All of one colour.
inline void paint(GaussianCloud& cloud) {
  std::fill(cloud.sh.begin(), cloud.sh.end(), 0.3f);
}

// Four kilometres long, so that what a frame sees is little of it, whatever a chunk spans. Of one
// colour, a clustered tree's extents are far below its boxes; of many, far above.
inline GaussianCloud long_street(bool of_one_colour) {
  GaussianCloud cloud = random_cloud(20000, 6, 1);
  for (size_t i = 0; i < cloud.size(); ++i) {
    cloud.position[3 * i] *= 200;
    cloud.position[3 * i + 1] *= 2;
    cloud.position[3 * i + 2] *= 2;
  }
  if (of_one_colour) paint(cloud);
  return cloud;
}

template <class Edit>
NamedCloud edited_cloud(const std::string& name, size_t count, const Edit& edit) {
  NamedCloud named{name, random_cloud(count, 7, 1)};
  for (size_t i = 0; i < count; ++i) edit(named.cloud, i);
  return named;
}

inline std::vector<NamedCloud> degenerate_clouds() {
  std::vector<NamedCloud> clouds;
  clouds.push_back(edited_cloud("one point", 150, [](GaussianCloud& c, size_t i) {
    for (size_t k = 0; k < 3; ++k) c.position[3 * i + k] = 1.5f;
  }));
  clouds.push_back(edited_cloud("identical", 100, [](GaussianCloud& c, size_t i) {
    for (size_t k = 0; k < 3; ++k) c.position[3 * i + k] = -2.0f;
    for (size_t k = 0; k < 3; ++k) c.log_scale[3 * i + k] = -1.0f;
    for (size_t k = 0; k < 4; ++k) c.rotation[4 * i + k] = k == 0 ? 1.0f : 0.0f;
    c.opacity[i] = 88.0f;
  }));
  clouds.push_back(edited_cloud("a line", 500, [](GaussianCloud& c, size_t i) {
    c.position[3 * i + 1] = c.position[3 * i + 2] = 0.0f;
  }));
  clouds.push_back(edited_cloud("outliers", 500, [](GaussianCloud& c, size_t i) {
    if (i % 100 == 3) c.position[3 * i + i / 100 % 3] = i % 200 == 3 ? 9e17f : -9e17f;
  }));
  clouds.push_back(edited_cloud("transparent", 300, [](GaussianCloud& c, size_t i) {
    c.opacity[i] = i < 200 ? -200.0f : -88.0f;  // sigmoid 0, and subnormal
  }));
  clouds.push_back(edited_cloud("needles", 150, [](GaussianCloud& c, size_t i) {
    c.log_scale[3 * i] = std::log(10.0f);
    c.log_scale[3 * i + 1] = c.log_scale[3 * i + 2] = std::log(1e-7f);
  }));
  clouds.push_back(edited_cloud("extreme scales", 150, [](GaussianCloud& c, size_t i) {
    for (size_t k = 0; k < 3; ++k)
      c.log_scale[3 * i + k] = (i + k) % 2 ? kMinLogScale : kMaxLogScale;
  }));
  clouds.push_back(edited_cloud("specks", 500, [](GaussianCloud& c, size_t i) {
    for (size_t k = 0; k < 3; ++k) c.log_scale[3 * i + k] = kMinLogScale;
    for (size_t k = 0; k < 3; ++k) c.position[3 * i + k] = 0.0f;
  }));
  clouds.push_back(edited_cloud("subnormal SH", 500, [](GaussianCloud& c, size_t i) {
    for (size_t k = 0; k < 12; ++k) c.sh[12 * i + k] *= 1e-42f;
  }));
  clouds.push_back(edited_cloud("largest SH", 200, [](GaussianCloud& c, size_t i) {
    for (size_t k = 0; k < 12; ++k) c.sh[12 * i + k] = (i + k) % 2 ? 3.4e38f : -3.4e38f;
  }));
  clouds.push_back(edited_cloud("far apart", 200, [](GaussianCloud& c, size_t i) {
    for (size_t k = 0; k < 3; ++k) c.position[3 * i + k] *= 9e17f / 10.0f;
    c.opacity[i] = i % 2 ? 88.0f : -88.0f;
  }));
  return clouds;
}

inline std::vector<NamedCloud> all_clouds() {
  std::vector<NamedCloud> clouds = degenerate_clouds();
  for (const size_t count : {1, 2, 3, 4, 5, 17, 1000, 3000})
    clouds.push_back({std::to_string(count) + " random", random_cloud(count, 11, 1)});
  return clouds;
}

}  // namespace voyager::test
