#pragma once
// What the host keeps of a resident chunk so that it can be linked (linker.h): some ten bytes for
// each of its subtrees. All else follows from that, and is found by a walk from the first subtree.
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "runtime/lod/subtree_cursor.h"
#include "runtime/math/count_bits.h"
#include "runtime/math/large_families.h"
#include "runtime/select/search_tree.h"

namespace voyager {

// An interior node on the lowest level of its tier: subtrees hang from it.
struct NodeBelow {
  uint32_t index;                     // among those of the chunk
  uint32_t place, record;             // in the chunk
  uint32_t first_child, child_count;  // as the file numbers them
};

// How many children nodes have with large families. parent: a place, counted from `base`.
struct LargeFamilies {
  std::span<const LargeFamily> families;
  uint32_t base;

  uint32_t children(uint32_t place) const {
    return children_of(base + place, families.data(), static_cast<uint32_t>(families.size()));
  }
};

class LinkTable {
 public:
  LinkTable() = default;
  // Of a chunk's subtrees in turn, and of those on its tiers' lowest levels that have children, how
  // many each has.
  struct Part {
    uint32_t levels;              // slot_levels()
    uint32_t interior, families;  // as in SearchSubtree
  };
  LinkTable(std::span<const Part> parts, std::span<const uint32_t> child_counts);

  uint32_t slot = 0, first_block = 0;  // of its records
  uint32_t first_subtree = 0;
  uint32_t next_root = 0;   // the first root that it owns in its first tier
  uint32_t next_below = 0;  // the first root that hangs from a node of its first tier

  bool empty() const { return words_ == nullptr; }
  uint32_t subtrees() const { return subtrees_; }
  uint32_t slots() const { return slots_; }  // of all of them
  uint32_t nodes_below() const { return nodes_below_; }

  // Whether a refined node may lead to a subtree.
  bool leads_to(uint32_t subtree) const { return (word(subtree) & kLinked) != 0; }
  // One thread at a time for a subtree, while others may ask.
  void set_leads_to(uint32_t subtree, bool linked) {
    words_[subtree].store(levels(subtree) | (linked ? kLinked : 0), std::memory_order_relaxed);
  }
  // Whether a node leads to what is below: that is there, and so is all above.
  bool leads_on(uint32_t below) const { return (below_byte(below) & kLeadsOn) != 0; }
  // False: it did so already. Of several threads it is true for one.
  bool begin_to_lead_on(uint32_t below) {
    const uint32_t mark = kLeadsOn << 8 * (below % 4);
    return (below_word(below).fetch_or(mark, std::memory_order_relaxed) & mark) == 0;
  }
  // False: it did not.
  bool end_to_lead_on(uint32_t below) {
    const uint32_t mark = kLeadsOn << 8 * (below % 4);
    return (below_word(below).fetch_and(~mark, std::memory_order_relaxed) & mark) != 0;
  }

  uint32_t levels(uint32_t subtree) const { return word(subtree) & ~kLinked; }
  // kManyChildren: or more.
  uint32_t few_children(uint32_t below) const { return below_byte(below) & kManyChildren; }
  // Bits of `count` slots, of which so many are before.
  uint32_t interior(uint32_t before, uint32_t count) const {
    return bits(subtrees_, before, count);
  }
  uint32_t families(uint32_t before, uint32_t count) const {
    return bits(subtrees_ + bit_words(), before, count);
  }

  // What a table takes: for each chunk of at most so many records, subtree, and node below.
  static constexpr uint64_t kSubtreeBytes = sizeof(uint32_t), kBelowBytes = 1;
  static constexpr uint64_t chunk_bytes(uint32_t records) {
    return sizeof(LinkTable) + (2 * words_of(records) + 1) * sizeof(uint32_t) + sizeof(uint32_t);
  }
  uint64_t bytes() const { return sizeof(LinkTable) + word_count() * sizeof(uint32_t); }

 private:
  // In slot_levels() neither is used.
  static constexpr uint32_t kLinked = 1u << 30;
  static constexpr uint32_t kLeadsOn = 0x80;
  static_assert(kManyChildren == kLeadsOn - 1);

  // With one to spare, since slots may lie astride two.
  static constexpr uint32_t words_of(uint32_t slots) { return slots / 32 + 1; }
  uint32_t bit_words() const { return words_of(slots_); }
  uint32_t below_at() const { return subtrees_ + 2 * bit_words() + 1; }
  size_t word_count() const { return below_at() + (size_t{nodes_below_} + 3) / 4; }
  uint32_t below_byte(uint32_t below) const {
    return word(below_at() + below / 4) >> 8 * (below % 4) & 0xff;
  }
  std::atomic<uint32_t>& below_word(uint32_t below) { return words_[below_at() + below / 4]; }
  uint32_t word(size_t i) const { return words_[i].load(std::memory_order_relaxed); }
  uint32_t bits(uint32_t from, uint32_t before, uint32_t count) const {
    const size_t at = from + before / 32;
    const uint64_t two = word(at) | uint64_t{word(at + 1)} << 32;
    return static_cast<uint32_t>(two >> before % 32) & slots_before(count);
  }
  void set_bits(size_t at, uint32_t bits);
  void put_bits(uint32_t from, uint32_t before, uint32_t slots);

  uint32_t subtrees_ = 0, nodes_below_ = 0, slots_ = 0;
  // Levels of each subtree; interior slots and first children of all; bytes of the nodes below.
  // Threads that link other chunks read them while two kinds of marks change.
  std::unique_ptr<std::atomic<uint32_t>[]> words_;
};

// From the first subtree of a chunk to its last, by their roots alone.
class RootWalk {
 public:
  // All outlive it.
  RootWalk(const LinkTable& table, const Tiers& tiers);

  bool at_end() const { return index_ == table_->subtrees(); }
  void next();

  const LinkTable& table() const { return *table_; }
  uint32_t index() const { return index_; }
  uint32_t subtree() const { return table_->first_subtree + index_; }
  uint32_t levels() const { return levels_; }
  uint32_t root() const { return next_root_ - (repeats_root() ? 1 : 0); }
  uint32_t root_count() const { return levels_ & 0xff; }
  bool repeats_root() const { return (levels_ >> 24 & 3) != 0; }
  bool repeats_child() const { return (levels_ >> 24 & 3) == 2; }
  uint32_t slot_count() const { return levels_ >> 16 & 0xff; }

 protected:
  // Of each level, the nodes that a subtree does not repeat.
  struct Owned {
    uint32_t roots, children, grandchildren;
  };
  static Owned owned(uint32_t levels) {
    const uint32_t first_child = levels & 0xff, first_grandchild = levels >> 8 & 0xff;
    const uint32_t repeated = levels >> 24 & 3;
    return {first_child - (repeated != 0 ? 1 : 0),
            first_grandchild - first_child - (repeated == 2 ? 1 : 0),
            (levels >> 16 & 0xff) - first_grandchild};
  }
  // The first level of the tier.
  uint32_t level() const {
    return tier_ == 0 ? 0 : tiers_->first_tier_levels + (tier_ - 1) * kTierLevels;
  }

  const LinkTable* table_;
  const Tiers* tiers_;
  uint32_t tier_, tier_end_;  // the end in the chunk, as an index
  uint32_t index_ = 0, levels_;
  uint32_t next_root_;

 private:
  void find_tier_end();
};

// The same with all that is known of them.
class LinkWalk : public RootWalk {
 public:
  // All outlive it.
  LinkWalk(const LinkTable& table, const Tiers& tiers, LargeFamilies large);

  void next();

  uint32_t interior() const { return interior_; }
  uint32_t families() const { return table_->families(slots_, slot_count()); }
  uint32_t child_count() const { return (levels_ >> 8 & 0xff) - (levels_ & 0xff); }
  // Of its nodes, those that nothing hangs from in its tier.
  uint32_t ends() const {
    const uint32_t owned = slots_before(slot_count()) & ~slots_before(levels_ >> 24 & 3);
    return count_bits(owned & ~(interior_ & ~lowest()));
  }
  // The place of the first node of a level that it owns.
  uint32_t place(uint32_t level) const { return place_[level]; }
  uint32_t first_record() const { return record_; }
  // The roots that hang from it, and from all before it in its tier, are before this one.
  uint32_t below_end() const { return below_end_; }
  // Those of its nodes that subtrees hang from, in their order.
  class NodesBelow {
   public:
    // at: outlives it, and stays where it is.
    explicit NodesBelow(const LinkWalk& at)
        : at_(&at), left_(at.lowest()), below_(at.below_), first_child_(at.next_below_) {
      read();
    }
    bool at_end() const { return left_ == 0; }
    void next() {
      left_ &= left_ - 1;
      ++below_;
      first_child_ += children_;
      read();
    }
    uint32_t children_begin() const { return first_child_; }
    uint32_t children_end() const { return first_child_ + children_; }
    NodeBelow operator*() const {
      const uint32_t before = count_bits(at_->interior_ & slots_before(slot()));
      return {below_, place(), at_->record_ + before, first_child_, children_};
    }

   private:
    uint32_t slot() const { return static_cast<uint32_t>(std::countr_zero(left_)); }
    uint32_t place() const {
      const uint32_t level = at_->height_ - 1;
      return at_->place_[level] + slot() - at_->first_slot(level);
    }
    void read() {
      if (at_end()) return;
      children_ = at_->table_->few_children(below_);
      if (children_ == kManyChildren) children_ = at_->large_.children(place());
    }

    const LinkWalk* at_;
    uint32_t left_;  // slots
    uint32_t below_, first_child_, children_ = 0;
  };
  // visit(NodeBelow) for each.
  template <class Visit>
  void each_below(const Visit& visit) const {
    for (NodesBelow below(*this); !below.at_end(); below.next()) visit(*below);
  }

 private:
  void start_tier();
  void read();
  uint32_t first_slot(uint32_t level) const {
    return level == 0 ? 0 : level == 1 ? levels_ & 0xff : levels_ >> 8 & 0xff;
  }
  uint32_t lowest() const { return interior_ & level_slots(height_ - 1, levels_); }

  LargeFamilies large_;
  uint32_t height_ = 0;
  uint32_t interior_ = 0;
  uint32_t slots_ = 0, record_ = 0, below_ = 0;  // of the subtrees before
  uint32_t next_below_, below_end_ = 0;
  std::array<uint32_t, 3> place_{};
  uint32_t nodes_ = 0;  // of the tiers of the chunk that are begun
};

}  // namespace voyager
