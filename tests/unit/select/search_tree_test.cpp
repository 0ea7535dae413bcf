// The tree as the partitioned searches read it, against the tree itself.
#include "runtime/select/search_tree.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <set>

#include "runtime/select/node_owners.h"
#include "tests/support/random_trees.h"
#include "tests/support/rounded_tree.h"

namespace voyager::search_tree_test {
namespace {

struct Cut {
  LodTree tree;
  Partition partition;
  SearchTree search;
};

Cut make(LodTree sound_tree, uint32_t chunk_bytes) {
  LodTree tree = test::rounded(std::move(sound_tree));
  Workers workers(2);
  Partition partition = partition_tree(tree, chunk_bytes);
  SearchTree search = make_search_tree(tree, partition, {}, workers);
  return {std::move(tree), std::move(partition), std::move(search)};
}

std::vector<Cut> all_cuts() {
  std::vector<Cut> cuts;
  for (const test::TreeShape shape : test::kTreeShapes)
    for (const uint32_t nodes : {1u, 2u, 40u, 2000u})
      cuts.push_back(make(test::random_tree(shape, nodes, nodes), kMinChunkBytes));
  return cuts;
}

TEST(SearchTree, OwnsEachNodeOnceAndHasARecordForEachInteriorSlot) {
  for (const Cut& cut : all_cuts()) {
    std::vector<uint32_t> owners(cut.tree.size());
    uint32_t records = 0;
    for (const SearchSubtree& s : cut.search.subtrees) {
      ASSERT_EQ(s.first_record, records);
      ASSERT_FALSE(s.missing());
      uint32_t families = 0;
      for (uint32_t slot = 0; slot < kSubtreeNodes; ++slot) {
        if ((s.owned() >> slot & 1) != 0) ++owners[s.node(slot)];
        if ((s.interior >> slot & 1) == 0) continue;
        const SearchRecord& r = cut.search.records[records++];
        const NodeRecord& n = cut.tree.records[s.node(slot)];
        ASSERT_GT(n.child_count, 0u);
        ASSERT_EQ(r.bounds().extent, n.extent);
        ASSERT_EQ(r.bounds().box_min.x, n.box_min.x);
        ASSERT_EQ(r.bounds().box_max.z, n.box_max.z);
        for (uint32_t left = r.child_slots(); left != 0; left &= left - 1)
          ASSERT_EQ(cut.tree.parent[s.node(static_cast<uint32_t>(std::countr_zero(left)))],
                    s.node(slot));
        if (r.child_slots() != 0) {
          ASSERT_EQ(r.child_slots() & s.families, r.child_slots() & (~r.child_slots() + 1));
        }
        families |= r.child_slots() & s.families;
      }
      ASSERT_EQ(families, s.families);
    }
    ASSERT_EQ(records, cut.search.records.size());
    for (const uint32_t count : owners) ASSERT_EQ(count, 1u);
  }
}

// The records that a node's weight depends on are found from that subtree.
TEST(SearchTree, TellsWhichSubtreeOwnsANode) {
  for (const Cut& cut : all_cuts()) {
    const OwnerRuns runs = make_owner_runs(cut.search);
    for (uint32_t n = 0; n < cut.tree.size(); ++n) {
      const SearchSubtree& s = cut.search.subtree(runs.view()(n));
      const uint32_t slot = s.slot_of(n);
      ASSERT_EQ(s.node(slot), n);
      ASSERT_TRUE(s.owned() >> slot & 1) << n;
    }
  }
}

// By its slots or by what it opens, a node leads to each of its children once.
TEST(SearchTree, LeadsToEveryChild) {
  for (const Cut& cut : all_cuts()) {
    std::vector<uint32_t> reached(cut.tree.size());
    for (const SearchSubtree& s : cut.search.subtrees) {
      uint32_t record = s.first_record;
      for (uint32_t left = s.interior; left != 0; left &= left - 1, ++record) {
        const uint32_t node = s.node(static_cast<uint32_t>(std::countr_zero(left)));
        const SearchRecord& r = cut.search.records[record];
        for (uint32_t slots = r.child_slots() & s.owned(); slots != 0; slots &= slots - 1)
          ++reached[s.node(static_cast<uint32_t>(std::countr_zero(slots)))];
        const SubtreeSpan below = subtrees_below(cut.search.subtrees.data(), {},
                                                 cut.search.subtree_count(), record, r.children);
        for (uint32_t i = below.first; i < below.last; ++i) {
          const SearchSubtree& under = cut.search.subtrees[i];
          ASSERT_EQ(under.entry, record);
          for (uint32_t root = 0; root < under.first_child_slot(); ++root) {
            ASSERT_EQ(cut.tree.parent[under.node(root)], node);
            reached[under.node(root)] += under.owned() >> root & 1;
          }
        }
      }
    }
    for (uint32_t n = 1; n < cut.tree.size(); ++n) ASSERT_EQ(reached[n], 1u) << n;
    ASSERT_EQ(reached[0], 0u);
  }
}

TEST(SearchTree, LevelsShareOutTheSlots) {
  for (uint32_t roots = 1; roots <= kSubtreeNodes; ++roots)
    for (uint32_t children = 0; roots + children <= kSubtreeNodes; ++children) {
      SearchSubtree s{};
      s.levels = slot_levels(roots, roots + children, kSubtreeNodes, 0);
      EXPECT_EQ(s.level_slots(0) | s.level_slots(1) | s.level_slots(2), 0x7fffffffu);
      EXPECT_EQ(static_cast<uint32_t>(std::popcount(s.level_slots(0))), roots);
      EXPECT_EQ(static_cast<uint32_t>(std::popcount(s.level_slots(1))), children);
      EXPECT_EQ(s.level_slots(0) & s.level_slots(1), 0u);
      EXPECT_EQ((s.level_slots(0) | s.level_slots(1)) & s.level_slots(2), 0u);
    }
}

TEST(SearchTree, HullsAreNeverSmallerThanWhatLeadsIntoTheChunk) {
  std::mt19937 random(1);
  for (const Cut& cut : all_cuts())
    for (size_t chunk = 0; chunk < cut.search.chunk_count; ++chunk) {
      const SearchChunk& c = cut.search.chunks[chunk];
      for (uint32_t s = c.first_subtree; s < c.last_subtree; ++s) {
        const uint32_t entry = cut.search.subtrees[s].entry;
        for (int place = 0; place < 3; ++place) {
          const Vec3f at{200 * test::unit(random) - 100, 200 * test::unit(random) - 100, 0};
          const float hull = decode_bounds(c.hull).screen_size(at);
          if (entry == kNoRecord) {
            ASSERT_EQ(hull, INFINITY);
            continue;
          }
          const NodeBounds r = cut.search.records[entry].bounds();
          ASSERT_GE(hull, screen_size(at, r.box_min, r.box_max, r.extent));
        }
      }
    }
}

TEST(SearchTree, KnowsWhetherLeavesHaveExtents) {
  LodTree tree = test::random_tree(test::TreeShape::four_way, 500, 1);
  EXPECT_FALSE(make(tree, kMinChunkBytes).search.leaves_have_extent);
  tree.records.back().extent = 1e-30f;
  EXPECT_TRUE(make(tree, kMinChunkBytes).search.leaves_have_extent);
}

TEST(SearchTree, OfAnEmptyTreeIsEmpty) {
  const Cut cut = make(LodTree(), kMinChunkBytes);
  EXPECT_EQ(cut.search.chunk_count, 0u);
  EXPECT_TRUE(cut.search.subtrees.empty());
}

// The nodes that lead into each range of what is missing.
using Leads = std::vector<std::set<uint32_t>>;

struct Damaged {
  std::vector<SubtreeRange> missing;
  Partition partition;
};

Damaged without(const Cut& whole, std::span<const size_t> chunks) {
  Damaged damaged{{}, whole.partition};
  for (const size_t chunk : chunks) {
    const uint32_t first = whole.partition.chunk_begin[chunk];
    const uint32_t last = whole.partition.chunk_begin[chunk + 1];
    const Subtree& subtree = whole.partition.subtrees[first];
    damaged.missing.push_back({first, last, subtree.root, subtree.repeats_root()});
    for (uint32_t s = first; s < last; ++s)
      damaged.partition.subtrees[s] = {kNoNode, 0, 0, 1, 0, 0, Repeats::nothing};
  }
  return damaged;
}

void expect_places(const Cut& whole, const Damaged& damaged) {
  Workers workers(2);
  const SearchTree search =
      make_search_tree(whole.tree, damaged.partition, damaged.missing, workers);
  std::vector<bool> lost(whole.tree.size());
  for (const SubtreeRange& range : damaged.missing)
    for (uint32_t s = range.first; s < range.last; ++s)
      for (uint32_t slot = 0; slot < whole.partition.subtrees[s].node_count(); ++slot)
        lost[whole.partition.subtrees[s].node(slot)] = true;
  Leads wanted(damaged.missing.size()), found(damaged.missing.size());
  size_t range = 0;
  for (uint32_t s = 0; s < search.subtrees.size(); ++s) {
    while (range < damaged.missing.size() && s >= damaged.missing[range].last) ++range;
    const bool is_missing = range < damaged.missing.size() && s >= damaged.missing[range].first;
    const SearchSubtree &a = search.subtrees[s], &b = whole.search.subtrees[s];
    const uint32_t above = b.entry == kNoRecord ? kNoNode : whole.tree.parent[b.root];
    const bool led_to = above != kNoNode && !lost[above];
    ASSERT_EQ(a.missing(), is_missing);
    if (!is_missing) {
      ASSERT_EQ(a.root, b.root);
      ASSERT_EQ(a.entry == kNoRecord, !led_to) << s;
      continue;
    }
    if (led_to) wanted[range].insert(above);
    if (a.entry != kNoRecord) found[range].insert(whole.tree.parent[a.root]);
  }
  ASSERT_EQ(found, wanted);
}

// Damage renames no other subtree, and what hangs below it is led to by nothing. What leads into a
// chunk that is missing leads to a subtree of that chunk and of no other.
TEST(SearchTree, MissingSubtreesKeepTheirPlaces) {
  for (const test::TreeShape shape : test::kTreeShapes) {
    const Cut whole = make(test::random_tree(shape, 2000, 1), kMinChunkBytes);
    for (size_t chunk = 0; chunk + 2 < whole.partition.chunk_begin.size(); chunk += 3) {
      SCOPED_TRACE(test::name_of(shape) + ", chunk " + std::to_string(chunk));
      expect_places(whole, without(whole, std::array{chunk}));
      expect_places(whole, without(whole, std::array{chunk, chunk + 1}));
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}

}  // namespace
}  // namespace voyager::search_tree_test
