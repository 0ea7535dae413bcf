#include "runtime/lod/build.h"

#include <algorithm>
#include <string>

#include "runtime/base/error.h"
#include "runtime/lod/align.h"
#include "runtime/lod/kd_order.h"
#include "runtime/lod/shape.h"
#include "runtime/lod/summarise.h"
#include "runtime/scene/sanitise.h"

namespace voyager {
namespace {

constexpr size_t kGrain = 256;  // nodes

// 0.36 of a merged Gaussian each (shape.h) still leaves node ids below kNoNode.
constexpr size_t kMaxGaussians = 3'000'000'000;

[[noreturn]] void refuse(size_t gaussian, const char* what, float found, const char* expected) {
  throw Error(ErrorCode::refused_input, "Gaussian " + std::to_string(gaussian) + ": " + what +
                                            " is " + std::to_string(found) + ", expected " +
                                            expected);
}

void check_means(const GaussianCloud& cloud, const std::array<double, 3>& origin) {
  for (size_t i = 0; i < cloud.size(); ++i) {
    const Vec3f mean = local_mean(cloud, i, origin);
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::fabs(mean[axis]) < kMaxCoordinate))
        refuse(i, "a position", mean[axis], "a magnitude below 1e18 m");
  }
}

void check_scales(const GaussianCloud& cloud) {
  for (size_t i = 0; i < cloud.log_scale.size(); ++i)
    if (!(cloud.log_scale[i] >= kMinLogScale && cloud.log_scale[i] <= kMaxLogScale))
      refuse(i / 3, "a log scale", cloud.log_scale[i], "ln 1e-9 to ln 1e6");
}

void allocate_merged(BakedScene& baked) {
  GaussianCloud& merged = baked.merged;
  const size_t count = baked.tree.size() - baked.leaves.size();
  merged.sh_degree = baked.leaves.sh_degree;
  merged.antialiased = baked.leaves.antialiased;
  merged.origin = baked.origin;
  merged.position.resize(3 * count);
  merged.log_scale.resize(3 * count);
  merged.rotation.resize(4 * count);
  merged.opacity.resize(count);
  merged.sh.resize(count * size_t{3} * static_cast<size_t>(merged.coefficients()));
}

// Nodes of one level depend on other levels only. `levels` as lay_out() gives them.
void fill_levels(const std::vector<uint32_t>& levels, BakedScene& baked, Workers& workers,
                 const Progress& progress) {
  const size_t nodes = baked.tree.size();
  const auto for_level = [&](size_t level, const auto& body) {
    workers.for_blocks(levels[level + 1] - levels[level], kGrain, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) body(levels[level] + static_cast<uint32_t>(i));
    });
  };
  for (size_t level = levels.size() - (nodes > 0); level-- > 0;) {
    for_level(level, [&](uint32_t node) { summarise(node, baked); });
    report(progress, "merging", nodes - levels[level], nodes);
  }
  for (size_t level = 0; level + 1 < levels.size(); ++level) {
    for_level(level, [&](uint32_t node) { align_children(node, baked); });
    report(progress, "aligning", levels[level + 1], nodes);
  }
}

}  // namespace

BakedScene build_tree(GaussianCloud cloud, Workers& workers, const Progress& progress) {
  const FloatingPointMode mode;
  if (cloud.size() > kMaxGaussians)
    throw Error(ErrorCode::refused_input, std::to_string(cloud.size()) +
                                              " Gaussians, expected at most " +
                                              std::to_string(kMaxGaussians));
  std::pmr::memory_resource* memory = cloud.position.get_allocator().resource();
  check_means(cloud, {0, 0, 0});
  check_scales(cloud);
  const std::array<double, 3> origin = scene_origin(cloud);
  check_means(cloud, origin);
  BakedScene baked{std::move(cloud),
                   GaussianCloud(memory),
                   origin,
                   LodTree(memory),
                   std::pmr::vector<uint32_t>(memory),
                   std::pmr::vector<uint8_t>(memory)};

  report(progress, "splitting", 0, baked.leaves.size());
  const std::vector<uint32_t> levels =
      lay_out(kd_order(baked.leaves, baked.origin, workers), baked);
  report(progress, "splitting", baked.leaves.size(), baked.leaves.size());

  baked.axis_code.resize(baked.tree.size());
  allocate_merged(baked);
  fill_levels(levels, baked, workers, progress);
  return baked;
}

}  // namespace voyager
