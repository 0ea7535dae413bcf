#include "runtime/select/search_tree.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <limits>

#include "runtime/base/first_that.h"
#include "runtime/select/search_records.h"
#include "runtime/select/set_bits.h"

namespace voyager {

uint32_t SearchTree::chunk_with(uint32_t subtree, uint32_t near) const {
  return first_near(near, chunk_count, [&](uint32_t i) { return chunk(i).last_subtree > subtree; });
}

namespace {

constexpr size_t kSubtreesAtOnce = 1024;

class Builder {
 public:
  Builder(const LodTree& tree, const Partition& partition, std::span<const SubtreeRange> missing,
          SearchTree& out)
      : tree_(tree), partition_(partition), missing_(missing), out_(out) {}

  void build(Workers& workers) {
    const size_t count = partition_.subtrees.size();
    out_.subtrees.resize(count);
    out_.tier_begin.assign(partition_.tier_begin.begin(), partition_.tier_begin.end());
    workers.for_blocks(count, kSubtreesAtOnce, [&](size_t begin, size_t end) {
      for (size_t s = begin; s < end; ++s) describe(static_cast<uint32_t>(s));
    });
    out_.leaves_have_extent = leaves_have_extent_;
    for (const SubtreeRange& range : missing_) describe_missing(range);
    number_records();
    workers.for_blocks(count, kSubtreesAtOnce, [&](size_t begin, size_t end) {
      for (size_t s = begin; s < end; ++s) fill_records(static_cast<uint32_t>(s));
    });
    for (size_t tier = 0; tier + 1 < out_.tier_begin.size(); ++tier) link(tier);
    set_chunks(workers);
  }

 private:
  uint32_t levels_of(uint32_t s) const {
    return s < out_.tier_begin[1] ? partition_.first_tier_levels : 3;
  }

  void describe(uint32_t s) {
    const Subtree& from = partition_.subtrees[s];
    SearchSubtree& to = out_.subtrees[s];
    to = {from.root, from.first_child, from.first_grandchild, slot_levels(from), 0, 0,
          0,         kNoRecord};
    if (is_missing(s)) return;
    const auto record = [&](uint32_t slot) -> auto& {
      return tree_.records[from.node(slot)];
    };
    to.interior = interior_slots(from, record);
    to.families = family_slots(from, record);
    bool extent = false;
    for (uint32_t slot = 0; slot < from.node_count(); ++slot)
      extent |= (to.interior >> slot & 1) == 0 && record(slot).extent != 0.0f;
    if (extent) leaves_have_extent_.store(true, std::memory_order_relaxed);
  }

  // missing_ is ascending and disjoint.
  bool is_missing(uint32_t s) const {
    const auto after = std::upper_bound(
        missing_.begin(), missing_.end(), s,
        [](uint32_t subtree, const SubtreeRange& range) { return subtree < range.first; });
    return after != missing_.begin() && s < std::prev(after)->last;
  }

  // How many roots each of them has is not known, and need not be: a frame that reaches any of a
  // node's subtrees needs the chunk. So there is one for each node that the roots hang from, in
  // their order; there are at least so many. Surplus subtrees are given to the last of these nodes.
  void describe_missing(const SubtreeRange& range) {
    uint32_t root = range.first_root;
    bool more = true;  // nodes, in this tier
    for (uint32_t s = range.first; s < range.last; ++s) {
      const auto tier =
          static_cast<size_t>(std::upper_bound(out_.tier_begin.begin(), out_.tier_begin.end(), s) -
                              out_.tier_begin.begin() - 1);
      if (s == out_.tier_begin[tier]) root = first_root(tier), more = true;
      out_.subtrees[s] = kUnlinkedSubtree;
      out_.subtrees[s].root = root;
      out_.subtrees[s].entry = kNoRecord;
      if (!more) continue;
      const uint32_t next = next_family(root, end_of_roots(range, tier));
      more = next != root;
      root = next;
    }
  }

  // The first root that hangs from another node, or the same where none does.
  uint32_t next_family(uint32_t root, uint32_t end) const {
    for (uint32_t next = root + 1; next < end; ++next)
      if (tree_.parent[next] != tree_.parent[root]) return next;
    return root;
  }

  size_t level_of(size_t tier) const {
    return tier == 0 ? 0 : partition_.first_tier_levels + 3 * (tier - 1);
  }
  uint32_t first_root(size_t tier) const { return partition_.level_begin[level_of(tier)]; }

  // Behind the last root that the range has, whether or not it goes on behind it.
  uint32_t end_of_roots(const SubtreeRange& range, size_t tier) const {
    if (range.last >= out_.tier_begin[tier + 1]) return partition_.level_begin[level_of(tier) + 1];
    const auto after = std::lower_bound(
        missing_.begin(), missing_.end(), range.last,
        [](const SubtreeRange& other, uint32_t subtree) { return other.first < subtree; });
    if (after != missing_.end() && after->first == range.last)
      return after->first_root + (after->repeats_root ? 1 : 0);
    const Subtree& next = partition_.subtrees[range.last];
    return next.root + (next.repeats_root() ? 1 : 0);
  }

  // A missing subtree has a record, too: what hangs below it is opened by that one,
  // which is to say never.
  void number_records() {
    uint32_t records = 0;
    for (SearchSubtree& subtree : out_.subtrees) {
      subtree.first_record = records;
      records += subtree.missing() ? 1 : count_bits(subtree.interior);
    }
    out_.records.resize(records);
  }

  void fill_records(uint32_t s) {
    if (out_.subtrees[s].missing()) return;
    const Subtree& subtree = partition_.subtrees[s];
    fill_search_records(
        subtree, [&](uint32_t slot) -> auto& { return tree_.records[subtree.node(slot)]; },
        out_.records.data() + out_.subtrees[s].first_record);
  }

  // The roots of the next tier, in order, are the children of this tier's lowest
  // nodes, in order.
  void link(size_t tier) {
    const bool last = tier + 2 == out_.tier_begin.size();
    const uint32_t end = last ? out_.tier_begin[tier + 1] : out_.tier_begin[tier + 2];
    uint32_t next = out_.tier_begin[tier + 1];
    for (uint32_t s = out_.tier_begin[tier]; s < out_.tier_begin[tier + 1]; ++s) {
      const SearchSubtree& subtree = out_.subtrees[s];
      uint32_t record = subtree.first_record;
      for (uint32_t left = subtree.interior; left != 0; left &= left - 1, ++record) {
        const auto slot = static_cast<uint32_t>(std::countr_zero(left));
        const bool lowest = is_lowest(s, slot);
        const uint32_t node = subtree.node(slot);
        const uint32_t first = tree_.first_child[node];
        while (lowest && next < end && out_.subtrees[next].root < first) ++next;
        if (!lowest) continue;
        out_.records[record].children = kLowest | next;
        const uint32_t after = first + tree_.records[node].child_count;
        for (; next < end && out_.subtrees[next].root < after; ++next)
          out_.subtrees[next].entry = record;
      }
    }
  }

  bool is_lowest(uint32_t s, uint32_t slot) const {
    return (out_.subtrees[s].level_slots(levels_of(s) - 1) >> slot & 1) != 0;
  }

  void set_chunks(Workers& workers) {
    const size_t count = partition_.chunk_count();
    out_.chunk_count = static_cast<uint32_t>(count);
    out_.chunks.resize(count);
    workers.for_blocks(count, kSubtreesAtOnce, [&](size_t begin, size_t end) {
      for (size_t chunk = begin; chunk < end; ++chunk) out_.chunks[chunk] = hull_of(chunk);
    });
  }

  SearchChunk hull_of(size_t chunk) const {
    const uint32_t first = partition_.chunk_begin[chunk], last = partition_.chunk_begin[chunk + 1];
    // Subtrees of the tree's root hang from nothing, and are always reached.
    if (first < out_.tier_begin[1]) return {encode_bounds(kAlwaysReached), first, last};
    constexpr float kMost = std::numeric_limits<float>::max();
    NodeBounds hull{{kMost, kMost, kMost}, 0, {-kMost, -kMost, -kMost}};
    bool is_reached = false;
    for (uint32_t s = first; s < last; ++s) {
      if (out_.subtrees[s].entry == kNoRecord) continue;
      const NodeBounds r = out_.records[out_.subtrees[s].entry].bounds();
      is_reached = true;
      hull.extent = std::max(hull.extent, r.extent);
      for (int axis = 0; axis < 3; ++axis) {
        hull.box_min[axis] = std::min(hull.box_min[axis], r.box_min[axis]);
        hull.box_max[axis] = std::max(hull.box_max[axis], r.box_max[axis]);
      }
    }
    // Where nothing leads into it, it may be reached from a point: nothing there is open.
    return {encode_bounds(is_reached ? hull : NodeBounds{}), first, last};
  }

  const LodTree& tree_;
  const Partition& partition_;
  std::span<const SubtreeRange> missing_;
  SearchTree& out_;
  std::atomic<bool> leaves_have_extent_{false};
};

}  // namespace

SearchTree make_search_tree(const LodTree& tree, const Partition& partition,
                            std::span<const SubtreeRange> missing, Workers& workers,
                            std::pmr::memory_resource* memory) {
  SearchTree out(memory);
  if (!partition.subtrees.empty()) Builder(tree, partition, missing, out).build(workers);
  return out;
}

}  // namespace voyager
