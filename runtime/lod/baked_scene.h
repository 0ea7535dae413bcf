#pragma once
// The result of a bake in memory, before it is written: leaves in the input's
// order, merged Gaussians beside them, and the tree over both.
#include <array>
#include <cstdint>
#include <vector>

#include "runtime/lod/tree.h"
#include "runtime/lod/tree_rule.h"
#include "runtime/math/node_code.h"
#include "runtime/scene/further_gaussians.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

// How a Gaussian shows among others (exposure.h).
struct Exposure {
  float seen;      // in (0, 1]
  float contrast;  // code values, at least 0
  // Opacity times surface times what is seen, of all its leaves (shown_weight()).
  float weight;
};

struct BakedScene {
  GaussianCloud leaves;  // the input's words, the input's order
  GaussianCloud merged;  // opacity linear, positions scene-local (its origin is `origin`)
  std::array<double, 3> origin{0, 0, 0};  // of the scene: 0, or a multiple of 1024 m (METHOD §2)
  LodTree tree;
  // Per node: index into `leaves` for a leaf, into `merged` otherwise.
  std::pmr::vector<uint32_t> gaussian;
  // Per node (runtime/math/node_code.h): how its stored axes turn to its parent's, 0 of merged
  // Gaussians, which are stored turned already; and which footprint it has. A merged one has the
  // smallest of its children's.
  std::pmr::vector<uint8_t> node_code;
  TreeKind kind = TreeKind::clustered;
  std::vector<Exposure> exposure;  // per node of a clustered tree; for building
  // Merged Gaussians have learned (runtime/optimize), and are not their children's moments.
  bool learned = false;
  // The tree is a .hier's own (kept_tree.h): opacities of leaves are linear, too, and neither boxes
  // of leaves nor merged Gaussians nor axes are what a build makes of them.
  bool kept = false;
  FurtherGaussians further{};  // of a kept tree

  // The opacity of the node's Gaussian is a logit.
  bool has_logit(uint32_t node) const { return tree.is_leaf(node) && !kept; }

  // METHOD §12's, metres².
  double footprint_of(uint32_t node) const {
    return footprint_at(leaves.native.footprint(), footprint_level_of(node_code[node]));
  }
};

// A Gaussian's mean in a scene's local metres: the one rounding to binary32 is here.
// `word` is three position words of a cloud.
inline Vec3f local_mean(const float* word, const std::array<double, 3>& cloud_origin,
                        const std::array<double, 3>& origin) {
  return {static_cast<float>((double{word[0]} + cloud_origin[0]) - origin[0]),
          static_cast<float>((double{word[1]} + cloud_origin[1]) - origin[1]),
          static_cast<float>((double{word[2]} + cloud_origin[2]) - origin[2])};
}
inline Vec3f local_mean(const GaussianCloud& cloud, size_t i, const std::array<double, 3>& origin) {
  return local_mean(&cloud.position[3 * i], cloud.origin, origin);
}

// Words of a leaf with its mean in the scene's local metres.
inline GaussianWords leaf_words(const BakedScene& baked, size_t i) {
  GaussianWords words = baked.leaves.words(i);
  words.mean = local_mean(baked.leaves, i, baked.origin);
  return words;
}

}  // namespace voyager
