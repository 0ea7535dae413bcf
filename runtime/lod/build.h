#pragma once
#include "runtime/base/progress.h"
#include "runtime/base/workers.h"
#include "runtime/lod/baked_scene.h"
#include "runtime/lod/block_footprints.h"

namespace voyager {

// Builds the tree over a sanitised cloud, which it takes over. Deterministic:
// the same cloud gives the same tree whatever the number of threads. An empty
// cloud gives an empty tree, a single Gaussian a single leaf. All
// of the result comes from the cloud's memory resource. O(n log n) time.
// Throws Error(refused_input) for coordinates that METHOD §3 excludes, scales
// beyond kMaxLogScale, and more Gaussians than 32-bit node ids can name.
// Where cloud.native has levels, each block gets its own footprint.
BakedScene build_tree(GaussianCloud cloud, Workers& workers, const Progress& progress = {},
                      const TreeRule& rule = {}, const BlockFootprints& footprints = {});

// Footprint levels that are used, of a tree or the top of one.
int footprint_levels(const BakedScene& baked);

// What build_tree() refuses of a cloud, for builders that never hold the whole: more
// Gaussians than kMaxGaussians, and a mean beyond the coordinates of METHOD §3.
// Two nodes for each merged Gaussian, of a tree of two children a node, leave node ids below
// kNoNode.
inline constexpr uint64_t kMaxGaussians = 1'400'000'000;
void check_count(uint64_t gaussians);
void check_mean(size_t gaussian, const Vec3f& mean);

// The scene's origin for bounds in world metres: 0, or a multiple of 1024 m
// where they reach beyond ±16 km; each axis on its own.
std::array<double, 3> scene_origin(const Vec3d& bounds_min, const Vec3d& bounds_max);

// The same for a cloud, by the bounds of the middle 96 % of its means on each
// axis (of an even sample): a stray Gaussian far out must not take the
// precision of all others away. What build_tree() uses; a scene drawn without
// a tree uses it too, so that both have the same local coordinates.
std::array<double, 3> scene_origin(const GaussianCloud& cloud);

// The same for a cloud that is elsewhere: the world positions of Gaussians 0, stride,
// 2 · stride, … of `gaussians`.
size_t origin_stride(size_t gaussians);
std::array<double, 3> scene_origin(const std::vector<Vec3d>& sample);

}  // namespace voyager
