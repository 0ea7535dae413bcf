#include "runtime/lod/summarise.h"

#include <algorithm>

#include "runtime/lod/build.h"

namespace voyager {
namespace {

void store(const GaussianWords& words, size_t i, GaussianCloud& cloud) {
  std::copy_n(&words.mean.x, 3, &cloud.position[3 * i]);
  std::copy_n(&words.log_scale.x, 3, &cloud.log_scale[3 * i]);
  std::copy_n(&words.rotation.w, 4, &cloud.rotation[4 * i]);
  cloud.opacity[i] = words.opacity;
}

// The longest side of nested boxes never grows downwards: binary32
// subtraction is monotone.
void hull_of_children(uint32_t node, LodTree& tree) {
  NodeRecord& r = tree.records[node];
  const NodeRecord* child = &tree.records[tree.first_child[node]];
  r.box_min = child->box_min;
  r.box_max = child->box_max;
  for (uint32_t i = 1; i < r.child_count; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      r.box_min[axis] = std::min(r.box_min[axis], child[i].box_min[axis]);
      r.box_max[axis] = std::max(r.box_max[axis], child[i].box_max[axis]);
    }
  }
  const Vec3f side = r.box_max - r.box_min;
  r.extent = std::max({side.x, side.y, side.z});
}

}  // namespace

Box leaf_box(const Gaussian& gaussian) {
  const Vec3f& s = gaussian.scale;
  const float reach = 3.0f * std::max({s.x, s.y, s.z});
  const Vec3f corner{reach, reach, reach};
  return {gaussian.mean - corner, gaussian.mean + corner};
}

MergeInput node_gaussian(uint32_t node, const BakedScene& baked) {
  const size_t i = baked.gaussian[node];
  const bool leaf = baked.tree.is_leaf(node);
  const GaussianCloud& cloud = leaf ? baked.leaves : baked.merged;
  const GaussianWords words = leaf ? leaf_words(baked, i) : cloud.words(i);
  const size_t floats = size_t{3} * static_cast<size_t>(cloud.coefficients());
  return {activate(words, leaf), cloud.sh.data() + i * floats};
}

void summarise(uint32_t node, BakedScene& baked) {
  NodeRecord& r = baked.tree.records[node];
  if (r.child_count == 0) {
    const Box box = leaf_box(node_gaussian(node, baked).gaussian);
    r.box_min = box.least;
    r.box_max = box.most;
    r.extent = 0.0f;
    return;
  }
  hull_of_children(node, baked.tree);
  MergeInput children[kChildren];
  for (uint32_t i = 0; i < r.child_count; ++i)
    children[i] = node_gaussian(baked.tree.first_child[node] + i, baked);
  const size_t index = baked.gaussian[node];
  const int coefficients = baked.merged.coefficients();
  float* sh = baked.merged.sh.data() + index * size_t{3} * static_cast<size_t>(coefficients);
  store(merge({children, r.child_count}, coefficients, sh).words, index, baked.merged);
}

}  // namespace voyager
