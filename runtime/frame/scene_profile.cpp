#include "runtime/frame/scene_profile.h"

#include <algorithm>
#include <mutex>

#include "runtime/frame/scene_gaussians.h"

namespace voyager {
namespace {

constexpr size_t kGrain = 1 << 16;

float anisotropy(const Vec3f& scale) {
  const auto [least, greatest] = std::minmax({scale.x, scale.y, scale.z});
  return greatest / least;
}

// Calls visit(node) for each of [begin, end) whose chunk was read: the others' Gaussians are
// stand-ins, and say nothing of the scene.
template <class Visit>
void each_sound(const std::vector<DamagedNodes>& damaged, size_t begin, size_t end,
                const Visit& visit) {
  auto lost = std::partition_point(damaged.begin(), damaged.end(), [&](const DamagedNodes& range) {
    return size_t{range.first} + range.count <= begin;
  });
  for (size_t node = begin; node < end; ++node) {
    for (; lost != damaged.end() && node >= lost->first; ++lost)
      node = size_t{lost->first} + lost->count;
    if (node < end) visit(node);
  }
}

// Of a run of Gaussians; runs are joined in any order.
struct Shapes {
  uint64_t above_one = 0;
  float least = 0, greatest = 0;

  void add(const Gaussian& g) {
    const float a = anisotropy(g.scale);
    above_one += g.opacity > 1.0f;
    least = greatest == 0 ? a : std::min(least, a);
    greatest = std::max(greatest, a);
  }
  void add(const Shapes& more) {
    above_one += more.above_one;
    if (more.greatest == 0) return;
    least = greatest == 0 ? more.least : std::min(least, more.least);
    greatest = std::max(greatest, more.greatest);
  }
};

}  // namespace

void complete_profile(Scene& scene, Workers& workers) {
  Shapes all;
  std::mutex joining;
  const GaussianArrays arrays = gaussian_arrays(scene);
  workers.for_blocks(gaussian_count(scene), kGrain, [&](size_t begin, size_t end) {
    Shapes own;
    each_sound(scene.damaged, begin, end,
               [&](size_t i) { own.add(arrays.gaussian(static_cast<uint32_t>(i))); });
    const std::lock_guard lock(joining);
    all.add(own);
  });
  SceneProfile& profile = scene.profile;
  profile.complete = true;
  profile.opacities_above_one = all.above_one;
  profile.least_anisotropy = all.least;
  profile.greatest_anisotropy = all.greatest;
}

}  // namespace voyager
