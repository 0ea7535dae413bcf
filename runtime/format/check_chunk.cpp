#include "runtime/format/check_chunk.h"

#include <cmath>

#include "runtime/math/axes.h"
#include "runtime/scene/sanitise.h"

namespace voyager {
namespace {

// exp() of it is finite and normal, and so are its square and sums of squares.
constexpr float kMaxLogScaleWord = 43.0f;

// Comparisons are written so that a NaN fails.
bool sound_box(const NodeRecord& r) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(r.box_min[axis] > -kMaxCoordinate && r.box_min[axis] <= r.box_max[axis] &&
          r.box_max[axis] < kMaxCoordinate))
      return false;
  return true;
}

bool below(const Vec3f& v, float bound) {
  return std::fabs(v.x) < bound && std::fabs(v.y) < bound && std::fabs(v.z) < bound;
}

bool finite(const Quatf& q) {
  return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
}

// What is wrong with node i, or nothing.
const char* fault(const Chunk& chunk, size_t i, const ChunkContext& context) {
  const NodeRecord& r = chunk.records[i];
  const GaussianWords& w = chunk.words[i];
  const bool leaf = r.child_count == 0;
  if (!sound_box(r)) return "a box that is not finite and ordered";
  if (!(r.extent >= 0 && std::isfinite(r.extent)))
    return "an extent that is negative or not finite";
  if (leaf ? chunk.source_index[i] >= context.leaf_count : chunk.source_index[i] != kNoNode)
    return "a source index that does not fit the node";
  if (chunk.axis_code[i] >= kAxisCodes) return "an axis code over 23";
  if (!below(w.mean, kMaxCoordinate)) return "a mean that is not finite and below 1e18";
  if (!below(w.log_scale, kMaxLogScaleWord)) return "a log scale out of range";
  if (!finite(w.rotation)) return "a rotation that is not finite";
  if (!std::isfinite(w.opacity) || (!leaf && w.opacity < 0)) return "an opacity out of range";
  const size_t floats = context.coefficients() * 3;
  for (size_t k = i * floats; k < (i + 1) * floats; ++k)
    if (!std::isfinite(chunk.sh[k])) return "an SH coefficient that is not finite";
  return nullptr;
}

}  // namespace

void check_chunk(const Chunk& chunk, const ChunkPlace& place, const ChunkContext& context) {
  uint64_t child = place.first_child;
  for (size_t i = 0; i < chunk.records.size(); ++i) {
    const uint64_t node = uint64_t{place.first_node} + i;
    const char* wrong = fault(chunk, i, context);
    if (!wrong && chunk.records[i].child_count != 0 && child <= node)
      wrong = "a child that comes before its parent";
    if (wrong) place.damaged("node " + std::to_string(node) + " with " + wrong, "a sound node");
    child += chunk.records[i].child_count;
  }
  if (child != place.next_first_child)
    place.damaged("children up to node " + std::to_string(child),
                  std::to_string(place.next_first_child));
}

}  // namespace voyager
