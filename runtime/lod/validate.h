#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/lod/baked_scene.h"

namespace voyager {

// Bounds that validate(BakedScene) holds a merged Gaussian to: what storing it
// in binary32 words may cost, with room to spare.
inline constexpr double kMeanTolerance =
    1e-6;  // of the mean's largest coordinate, and of its largest scale
inline constexpr double kCovarianceTolerance = 2e-5;  // of the covariance's trace
inline constexpr double kWeightTolerance = 1e-6;      // o·A(s), relative
inline constexpr double kShTolerance = 1e-6;          // of the largest coefficient of the children
inline constexpr double kAxisTolerance = 1e-6;        // of the quaternions' |dot|

// Every violated invariant of tree.h (at most `limit` of them), each naming
// node, found and expected; empty for a sound tree. Safe for any content of the
// tree, such as one decoded from a file. O(n).
std::vector<std::string> validate(const LodTree& tree, size_t limit = 16);

// The tree's, and also: leaf boxes cover mean ± 3·max(s), every Gaussian of the
// input is exactly one leaf, every merged one exactly one interior node, parents
// match their children's moments, axis codes are nearest. Where the tree itself
// is unsound, only that is reported. For tests and `bake --verify`.
std::vector<std::string> validate(const BakedScene& baked, size_t limit = 16);

}  // namespace voyager
