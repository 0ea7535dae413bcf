#include "runtime/lod/align.h"

#include "runtime/math/axes.h"

namespace voyager {
namespace {

void turn_merged(size_t i, int code, GaussianCloud& merged) {
  float* s = &merged.log_scale[3 * i];
  const Vec3f turned = turn_scale(Vec3f{s[0], s[1], s[2]}, code);
  for (int axis = 0; axis < 3; ++axis) s[axis] = turned[axis];
  float* q = &merged.rotation[4 * i];
  const Quatd r = normalise(Quatd{q[0], q[1], q[2], q[3]}) * cube_rotation<double>(code);
  q[0] = static_cast<float>(r.w);
  q[1] = static_cast<float>(r.x);
  q[2] = static_cast<float>(r.y);
  q[3] = static_cast<float>(r.z);
}

}  // namespace

Quatd stored_rotation(uint32_t node, const BakedScene& baked) {
  const GaussianCloud& cloud = baked.tree.is_leaf(node) ? baked.leaves : baked.merged;
  const float* q = &cloud.rotation[4 * size_t{baked.gaussian[node]}];
  return normalise(Quatd{q[0], q[1], q[2], q[3]});
}

void align_children(uint32_t node, BakedScene& baked) {
  const uint32_t count = baked.tree.records[node].child_count;
  if (count == 0) return;
  const Quatd parent = stored_rotation(node, baked);
  for (uint32_t child = baked.tree.first_child[node], i = 0; i < count; ++i, ++child) {
    const int code = nearest_axis_code(parent, stored_rotation(child, baked));
    if (baked.tree.is_leaf(child))
      baked.node_code[child] = node_code(code, footprint_level_of(baked.node_code[child]));
    else
      turn_merged(baked.gaussian[child], code, baked.merged);
  }
}

}  // namespace voyager
