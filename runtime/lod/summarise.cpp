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

// Of its children's: what is more in the others goes into the merged Gaussian.
void take_least_footprint(uint32_t node, BakedScene& baked) {
  const uint32_t first = baked.tree.first_child[node];
  int level = 0;
  for (uint32_t i = 0; i < baked.tree.records[node].child_count; ++i)
    level = std::max(level, footprint_level_of(baked.node_code[first + i]));
  baked.node_code[node] = node_code(0, level);
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
    weights[i] = children[i].weight;
    extent = std::max(extent, baked.tree.records[first + i].extent);
  }
  const std::span<const Exposure> exposure(&baked.exposure[first], r.child_count);
  Blob blobs[kChildren];
  const MergeInput parent = node_gaussian(node, baked);
  Group group = group_of(children, blobs, parent, baked.merged.coefficients());
  group.footprint = baked.footprint_of(node);
  group.low_pass = baked.leaves.native.low_pass;
  baked.exposure[node] = set_exposure(exposure, {weights, r.child_count}, group);
  const StandIn found = stand_in(group);
  r.extent = std::max(extent, static_cast<float>(extent_of(found.pixel)));
  baked.merged.opacity[baked.gaussian[node]] = static_cast<float>(found.opacity);
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
  return {activate(words, baked.has_logit(node)), cloud.sh.data() + i * floats};
}

MergeInput merge_input(uint32_t node, double footprint, const BakedScene& baked) {
  MergeInput input = node_gaussian(node, baked);
  if (const double more = baked.footprint_of(node) - footprint; more > 0) {
    Gaussian wider = input.gaussian;
    wider.scale = widened(wider.scale, static_cast<float>(more));
    input = {wider, input.sh};
  }
  if (baked.kind == TreeKind::clustered) input.weight = double{baked.exposure[node].weight};
  return input;
}

void summarise(uint32_t node, BakedScene& baked) {
  NodeRecord& r = baked.tree.records[node];
  if (r.child_count == 0) {
    const Gaussian leaf = node_gaussian(node, baked).gaussian;
    const Box box = leaf_box(leaf);
    r.box_min = box.least;
    r.box_max = box.most;
    r.extent = 0.0f;
    if (baked.kind == TreeKind::clustered)
      baked.exposure[node].weight =
          shown_weight(leaf, baked.exposure[node], baked.footprint_of(node));
    return;
  }
  const uint32_t first = baked.tree.first_child[node];
  hull_of_children(node, baked.tree);
  take_least_footprint(node, baked);
  const double footprint = baked.footprint_of(node);
  MergeInput children[kChildren];
  for (uint32_t i = 0; i < r.child_count; ++i)
    children[i] = merge_input(first + i, footprint, baked);
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
