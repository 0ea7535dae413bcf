#include "runtime/lod/summarise.h"

#include <algorithm>

#include "runtime/lod/shape.h"
#include "runtime/lod/stand_in.h"

namespace voyager {
namespace {

void store(const GaussianWords& words, size_t i, GaussianCloud& cloud) {
  std::copy_n(&words.mean.x, 3, &cloud.position[3 * i]);
  std::copy_n(&words.log_scale.x, 3, &cloud.log_scale[3 * i]);
  std::copy_n(&words.rotation.w, 4, &cloud.rotation[4 * i]);
  cloud.opacity[i] = words.opacity;
}

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
}

// HierarchicalGS's extent: of nested boxes it never grows downwards, since binary32 subtraction
// is monotone.
float longest_side(const NodeRecord& r) {
  const Vec3f side = r.box_max - r.box_min;
  return std::max({side.x, side.y, side.z});
}

Group group_of(std::span<const MergeInput> children, std::span<Blob> blobs,
               const MergeInput& parent, int coefficients) {
  const float* colours[kChildren];
  for (size_t i = 0; i < children.size(); ++i) {
    blobs[i] = blob_of(children[i].gaussian);
    colours[i] = children[i].sh;
  }
  Group group;
  group.children = blobs.first(children.size());
  group.parent = blob_of(parent.gaussian);
  set_colours({colours, children.size()}, parent.sh, coefficients, group);
  return group;
}

// Extent and opacity from what standing in for the children costs.
void measure(uint32_t node, std::span<const MergeInput> children, BakedScene& baked) {
  NodeRecord& r = baked.tree.records[node];
  const uint32_t first = baked.tree.first_child[node];
  float extent = 0;
  double weights[kChildren];
  for (uint32_t i = 0; i < r.child_count; ++i) {
    weights[i] = merge_weight(children[i].gaussian);
    extent = std::max(extent, baked.tree.records[first + i].extent);
  }
  const std::span<const Exposure> exposure(&baked.exposure[first], r.child_count);
  Blob blobs[kChildren];
  const MergeInput parent = node_gaussian(node, baked);
  Group group = group_of(children, blobs, parent, baked.merged.coefficients());
  baked.exposure[node] = set_exposure(exposure, {weights, r.child_count}, group);
  const StandIn found = stand_in(group);
  r.extent = std::max(extent, static_cast<float>(extent_of(found.pixel)));
  baked.merged.opacity[baked.gaussian[node]] = static_cast<float>(found.opacity);
  for (uint32_t i = 0; i < r.child_count; ++i) {
    NodeRecord& child = baked.tree.records[first + i];
    // A leaf is exact as itself; a double is as good as its child.
    if (child.child_count <= 1) child.extent = late_extent(child.extent, r.extent);
  }
}

// As its child, which is interior.
void repeat(uint32_t node, uint32_t child, BakedScene& baked) {
  const NodeRecord& of = baked.tree.records[child];
  NodeRecord& r = baked.tree.records[node];
  r.box_min = of.box_min;
  r.box_max = of.box_max;
  r.extent = of.extent;
  baked.exposure[node] = baked.exposure[child];
  GaussianCloud& cloud = baked.merged;
  const size_t from = baked.gaussian[child], to = baked.gaussian[node];
  store(cloud.words(from), to, cloud);
  const size_t floats = size_t{3} * static_cast<size_t>(cloud.coefficients());
  std::copy_n(&cloud.sh[from * floats], floats, &cloud.sh[to * floats]);
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
  const uint32_t first = baked.tree.first_child[node];
  if (r.child_count == 1) return repeat(node, first, baked);
  hull_of_children(node, baked.tree);
  MergeInput children[kChildren];
  for (uint32_t i = 0; i < r.child_count; ++i) children[i] = node_gaussian(first + i, baked);
  const size_t index = baked.gaussian[node];
  const int coefficients = baked.merged.coefficients();
  float* sh = baked.merged.sh.data() + index * size_t{3} * static_cast<size_t>(coefficients);
  store(merge({children, r.child_count}, coefficients, sh).words, index, baked.merged);
  if (baked.kind == TreeKind::hierarchicalgs)
    r.extent = longest_side(r);
  else
    measure(node, {children, r.child_count}, baked);
}

}  // namespace voyager
