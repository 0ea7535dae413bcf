#include "runtime/format/check_chunk.h"

#include <bit>
#include <cmath>

#include "runtime/math/node_code.h"
#include "runtime/scene/sanitise.h"

namespace voyager {
namespace {

// exp() of it is finite and normal, and so are its square and sums of squares. And kScaleBits hold
// what is below (runtime/math/shape_code.h).
constexpr float kMaxLogScaleWord = 43.0f;

// Comparisons are written so that a NaN fails.
bool sound_box(const NodeRecord& r) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(r.box_min[axis] > -kMaxCoordinate && r.box_min[axis] <= r.box_max[axis] &&
          r.box_max[axis] < kMaxCoordinate))
      return false;
  return true;
}

void check_records(const Chunk& chunk, const ChunkLocation& location, const ChunkContext& context) {
  for (size_t i = 0; i < chunk.records.size(); ++i) {
    const NodeRecord& r = chunk.records[i];
    const char* wrong = !sound_box(r)      ? "a box that is not finite and ordered"
                        : !(r.extent >= 0) ? "an extent that is negative or not a number"
                        : r.child_count == 0 && r.extent != 0 && !context.leaves_have_extent
                            ? "a leaf with an extent, though the header says that no leaf has one"
                            : nullptr;
    if (wrong) location.damaged("record " + std::to_string(i) + " with " + wrong, "a valid record");
  }
}

bool below(const Vec3f& v, float bound) {
  return std::fabs(v.x) < bound && std::fabs(v.y) < bound && std::fabs(v.z) < bound;
}

bool finite(const Quatf& q) {
  return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
}

// Magnitudes in the order of their bits, infinities and NaNs last; without an early end,
// so that it runs several at a time.
bool at_most(const float* values, size_t count, float largest) {
  const uint32_t bound = std::bit_cast<uint32_t>(largest);
  uint32_t bad = 0;
  for (size_t i = 0; i < count; ++i)
    bad |= (std::bit_cast<uint32_t>(values[i]) & 0x7fffffffu) > bound ? 1u : 0u;
  return bad == 0;
}

// What is wrong with owned node i, or nothing.
const char* fault(const Chunk& chunk, size_t i, const ChunkContext& context) {
  const GaussianWords& w = chunk.words[i];
  const bool leaf = chunk.is_leaf(i);
  if (leaf ? chunk.source_index[i] >= context.leaf_count : chunk.source_index[i] != kNoNode)
    return "a source index that does not fit the node";
  if (!below(w.mean, kMaxCoordinate)) return "a mean that is not finite and below 1e18";
  if (!below(w.log_scale, kMaxLogScaleWord)) return "a log scale out of range";
  if (!finite(w.rotation)) return "a rotation that is not finite";
  if (!std::isfinite(w.opacity) || (!chunk.has_logit(i) && w.opacity < 0))
    return "an opacity out of range";
  const size_t floats = context.coefficients() * 3;
  if (!at_most(chunk.sh.data() + i * floats, floats, context.largest_sh))
    return "an SH coefficient that is not finite, or beyond the header's largest";
  return nullptr;
}

// `first` is of the subtree's records.
void list_nodes(const Subtree& subtree, const SubtreeCursor& cursor, size_t first, Chunk& chunk) {
  for (uint32_t slot = subtree.first_owned_slot(); slot < subtree.node_count(); ++slot) {
    chunk.node.push_back(subtree.node(slot));
    chunk.record.push_back(static_cast<uint32_t>(first + slot));
    chunk.first_child.push_back(cursor.first_children()[slot]);
  }
}

}  // namespace

void link_subtrees(std::span<const SubtreeCounts> counts, const ChunkLocation& location,
                   const ChunkContext& context, Chunk& chunk) {
  check_records(chunk, location, context);
  SubtreeCursor cursor(context.tiers);
  const ChunkEntry& entry = location.entry;
  if (!cursor.move_to(entry.first_subtree, entry.place))
    location.damaged("a first subtree where none can be", "one that follows the chunk before");
  size_t record = 0;
  for (size_t i = 0; i < counts.size(); ++i) {
    const size_t count = size_t{counts[i].roots} + counts[i].children + counts[i].grandchildren;
    Subtree subtree{};
    const char* wrong = count > chunk.records.size() - record
                            ? "more nodes than there are records"
                            : cursor.take(counts[i], chunk.records.data() + record, subtree);
    if (wrong)
      location.damaged("subtree " + std::to_string(entry.first_subtree + i) + " with " + wrong,
                       "a sound subtree");
    list_nodes(subtree, cursor, record, chunk);
    chunk.subtrees.push_back(subtree);
    record += count;
  }
  if (record != chunk.records.size() || chunk.node.size() != entry.node_count ||
      cursor.place() != location.next)
    location.damaged("subtrees that end at record " + std::to_string(record) + " and node " +
                         std::to_string(cursor.place().next[0]),
                     "record " + std::to_string(chunk.records.size()) + " and node " +
                         std::to_string(location.next.next[0]));
}

void check_words(const Chunk& chunk, const ChunkLocation& location, const ChunkContext& context) {
  const int codes = kAxisCodes * context.footprint_levels;
  for (size_t i = 0; i < chunk.node.size(); ++i) {
    if (chunk.node_code[i] >= codes)
      location.damaged("node " + std::to_string(chunk.node[i]) + " with node code " +
                           std::to_string(chunk.node_code[i]),
                       "less than " + std::to_string(codes));
    if (const char* wrong = fault(chunk, i, context))
      location.damaged("node " + std::to_string(chunk.node[i]) + " with " + wrong, "a sound node");
  }
}

}  // namespace voyager
