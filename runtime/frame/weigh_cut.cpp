#include "runtime/frame/weigh_cut.h"

#include <bit>

#include "runtime/select/partitioned_blocks.h"
#include "runtime/select/set_bits.h"

namespace voyager {
namespace {

// The children of one node, or those of them that a subtree holds.
struct Family {
  uint32_t parent;  // node
  float size;       // the parent's
  bool saturated;   // t = 1, whatever the child's own size
  float leaf_t;     // of a child whose own size is 0
  float inverse_k;
};

class BlockWeights {
 public:
  BlockWeights(const NodeLinks& links, const SearchTree& search_tree, const CutQuery& query)
      : links_(links), search_tree_(search_tree), query_(query) {}

  void weigh(const PartitionedSearch& search, const PartitionedSearch::Block& block,
             DrawItem* items) {
    for (uint32_t level = 0; level < 3; ++level) {
      if (block.size[level] == 0) continue;
      DrawItem* out = items + block.at[level];
      end_ = out + block.size[level];
      for (uint32_t s = block.first; s < block.last; ++s) {
        const uint32_t cut = search.cut_slots(s);
        if (cut == 0) continue;
        const SearchSubtree& subtree = search_tree_.subtree(s);
        const uint32_t slots = cut & subtree.level_slots(level);
        if (slots != 0) out = weigh_level(s, level, slots, out);
      }
    }
  }

 private:
  DrawItem* weigh_level(uint32_t s, uint32_t level, uint32_t slots, DrawItem* out) {
    const SearchSubtree& subtree = search_tree_.subtree(s);
    if (level == 0) return weigh_roots(s, slots, out);
    // Each parent's own, in the order of the parents.
    const bool split = is_split(s);
    const uint32_t parents = subtree.interior & subtree.level_slots(level - 1);
    uint32_t k = level == 1 ? 0 : count_bits(subtree.interior & subtree.level_slots(0));
    for (uint32_t left = parents; left != 0; left &= left - 1, ++k) {
      const uint32_t record = subtree.record(k, search_tree_.next_block.data());
      const uint32_t own = search_tree_.records[record].child_slots() & slots;
      if (own == 0) continue;
      const uint32_t parent = subtree.node(static_cast<uint32_t>(std::countr_zero(left)));
      out = weigh_slots(subtree, family(record, parent, split), own, out);
    }
    return out;
  }

  DrawItem* weigh_roots(uint32_t s, uint32_t slots, DrawItem* out) {
    const uint32_t place = search_tree_.places()(s);
    const SearchSubtree& subtree = search_tree_.subtrees[place];
    if (subtree.entry == kNoRecord) {
      *out = whole(subtree.root);
      return out + 1;
    }
    // Neighbours may hang from one parent.
    if (subtree.entry != entry_) {
      entry_ = subtree.entry;
      entry_family_ = family(entry_, links_.parent_of_root(place, subtree.root), true);
    }
    return weigh_slots(subtree, entry_family_, slots, out);
  }

  // Whether the root may have children in other subtrees, too.
  bool is_split(uint32_t s) const {
    const uint32_t root = search_tree_.subtree(s).root;
    return (s > 0 && search_tree_.subtree(s - 1).root == root) ||
           (s + 1 < search_tree_.subtree_count() && search_tree_.subtree(s + 1).root == root);
  }

  // split: the record's slots may not be all of the children.
  Family family(uint32_t record, uint32_t parent, bool split) const {
    const SearchRecord& r = search_tree_.records[record];
    const float size = size_of(r.bounds()), target = query_.target_size;
    if (is_drawn_whole(size, target, links_.blend_share)) return {parent, size, true, 1.0f, 1.0f};
    const uint32_t children = split ? links_.children(parent) : count_bits(r.child_slots());
    return {parent, size, false, interpolation_weight(true, size, 0.0f, target, links_.blend_share),
            1.0f / static_cast<float>(children)};
  }

  // Of NodeBounds or NodeRecord.
  template <class Bounds>
  float size_of(const Bounds& b) const {
    return screen_size(query_.centre, b.box_min, b.box_max, b.extent);
  }

  float own_size(const SearchSubtree& subtree, uint32_t slot) const {
    if ((subtree.interior >> slot & 1) == 0) return leaf_size(links_.records[subtree.node(slot)]);
    const uint32_t below = subtree.interior & slots_before(slot);
    const uint32_t record = subtree.record(count_bits(below), search_tree_.next_block.data());
    return size_of(search_tree_.records[record].bounds());
  }

  float leaf_size(const NodeRecord& r) const { return r.extent == 0.0f ? 0.0f : size_of(r); }
  bool leaves_have_extent() const { return search_tree_.leaves_have_extent; }

  // slots: of one level, not 0.
  DrawItem* weigh_slots(const SearchSubtree& subtree, const Family& f, uint32_t slots,
                        DrawItem* out) const {
    const auto first = static_cast<uint32_t>(std::countr_zero(slots));
    const uint32_t node = subtree.node(first);
    const DrawItem item =
        f.leaf_t == 1.0f ? whole(0) : DrawItem{0, f.parent, f.leaf_t, f.inverse_k};
    DrawItem* const after = put_set_bits<4>(slots >> first, out, end_, [&](uint32_t place) {
      return DrawItem{node + place, item.parent, item.t, item.inverse_k};
    });
    const uint32_t own = leaves_have_extent() ? slots : slots & subtree.interior;
    if (!f.saturated && own != 0) weigh_own(subtree, f, slots, own, out);
    return after;
  }

  // Those of `slots` that have a size of their own.
  void weigh_own(const SearchSubtree& subtree, const Family& f, uint32_t slots, uint32_t own,
                 DrawItem* items) const {
    for (; own != 0; own &= own - 1) {
      const auto slot = static_cast<uint32_t>(std::countr_zero(own));
      const float t = interpolation_weight(true, f.size, own_size(subtree, slot),
                                           query_.target_size, links_.blend_share);
      const uint32_t node = subtree.node(slot);
      items[count_bits(slots & slots_before(slot))] =
          t == 1.0f ? whole(node) : DrawItem{node, f.parent, t, f.inverse_k};
    }
  }

  static DrawItem whole(uint32_t node) { return {node, kNoNode, 1.0f, 1.0f}; }

  const NodeLinks links_;
  const SearchTree& search_tree_;
  const CutQuery query_;
  const DrawItem* end_ = nullptr;  // of the piece in progress
  uint32_t entry_ = kNoRecord;
  Family entry_family_{};
};

}  // namespace

void weigh_cut(const NodeLinks& links, const SearchTree& search_tree,
               const PartitionedSearch& search, const CutQuery& query, std::span<DrawItem> items,
               Workers& workers) {
  const auto blocks = search.blocks();
  workers.for_blocks(blocks.size(), kBlocksTask, [&](size_t begin, size_t end) {
    BlockWeights weights(links, search_tree, query);
    for (size_t b = begin; b < end; ++b) weights.weigh(search, blocks[b], items.data());
  });
}

}  // namespace voyager
