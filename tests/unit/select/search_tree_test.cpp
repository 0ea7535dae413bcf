// The tree as the partitioned searches read it, against the tree itself.
#include "runtime/select/search_tree.h"

#include <gtest/gtest.h>

#include <bit>
#include <set>

#include "tests/support/random_trees.h"

namespace voyager::search_tree_test {
namespace {

struct Cut {
  LodTree tree;
  Partition partition;
  SearchTree search;
};

Cut make(LodTree tree, uint32_t chunk_bytes) {
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
      for (uint32_t slot = 0; slot < kSubtreeNodes; ++slot) {
        if ((s.owned >> slot & 1) != 0) ++owners[s.node(slot)];
        if ((s.interior >> slot & 1) == 0) continue;
        const SearchRecord& r = cut.search.records[records++];
        const NodeRecord& n = cut.tree.records[s.node(slot)];
        ASSERT_GT(n.child_count, 0u);
        ASSERT_EQ(r.extent, n.extent);
        ASSERT_EQ(r.box_min.x, n.box_min.x);
        ASSERT_EQ(r.box_max.z, n.box_max.z);
        for (uint32_t left = r.child_slots(); left != 0; left &= left - 1)
          ASSERT_EQ(cut.tree.parent[s.node(static_cast<uint32_t>(std::countr_zero(left)))],
                    s.node(slot));
      }
    }
    ASSERT_EQ(records, cut.search.records.size());
    for (const uint32_t count : owners) ASSERT_EQ(count, 1u);
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
        for (uint32_t slots = r.child_slots() & s.owned; slots != 0; slots &= slots - 1)
          ++reached[s.node(static_cast<uint32_t>(std::countr_zero(slots)))];
        const SubtreeSpan below = subtrees_below(cut.search.subtrees.data(),
                                                 cut.search.subtree_count(), record, r.children);
        for (uint32_t i = below.first; i < below.last; ++i) {
          const SearchSubtree& under = cut.search.subtrees[i];
          ASSERT_EQ(under.entry, record);
          for (uint32_t root = 0; root < under.first_child_slot(); ++root) {
            ASSERT_EQ(cut.tree.parent[under.node(root)], node);
            reached[under.node(root)] += under.owned >> root & 1;
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
      s.levels = slot_levels(roots, roots + children);
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
    for (size_t chunk = 0; chunk < cut.search.chunk_count(); ++chunk) {
      const SearchChunk& c = cut.search.chunks[chunk];
      for (uint32_t s = c.first_subtree; s < cut.search.chunks[chunk + 1].first_subtree; ++s) {
        const uint32_t entry = cut.search.subtrees[s].entry;
        for (int place = 0; place < 3; ++place) {
          const Vec3f at{200 * test::unit(random) - 100, 200 * test::unit(random) - 100, 0};
          const float hull = screen_size(at, c.hull_min, c.hull_max, c.extent);
          if (entry == kNoRecord) {
            ASSERT_EQ(hull, INFINITY);
            continue;
          }
          const SearchRecord& r = cut.search.records[entry];
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
  EXPECT_EQ(cut.search.chunk_count(), 0u);
  EXPECT_TRUE(cut.search.subtrees.empty());
}

// Whether a subtree of the partition holds the node.
bool holds(const Subtree& subtree, uint32_t node) {
  for (uint32_t slot = 0; slot < subtree.node_count(); ++slot)
    if (subtree.node(slot) == node) return true;
  return false;
}

// Damage renames no other subtree, and what hangs below it is led to by nothing. What leads into it
// leads to a subtree that is missing.
TEST(SearchTree, MissingSubtreesKeepTheirPlaces) {
  Workers workers(2);
  for (const test::TreeShape shape : {test::TreeShape::four_way, test::TreeShape::mixture}) {
    const Cut whole = make(test::random_tree(shape, 2000, 1), kMinChunkBytes);
    const auto& chunk_begin = whole.partition.chunk_begin;
    for (size_t chunk = 0; chunk + 1 < chunk_begin.size(); chunk += 5) {
      const uint32_t first = chunk_begin[chunk], last = chunk_begin[chunk + 1];
      const auto lost = std::span(whole.partition.subtrees).subspan(first, last - first);
      Partition partition = whole.partition;
      for (uint32_t s = first; s < last; ++s)
        partition.subtrees[s] = {kNoNode, 0, 0, 1, 0, 0, Repeats::nothing};
      const SubtreeRange missing{first, last, lost.front().root};
      const SearchTree search = make_search_tree(whole.tree, partition, {&missing, 1}, workers);
      std::set<uint32_t> wanted, found;  // parents that lead into what is missing
      for (uint32_t s = 0; s < search.subtrees.size(); ++s) {
        const SearchSubtree &a = search.subtrees[s], &b = whole.search.subtrees[s];
        const uint32_t above = b.entry == kNoRecord ? kNoNode : whole.tree.parent[b.root];
        const bool is_lost = std::ranges::any_of(
            lost, [&](const Subtree& subtree) { return holds(subtree, above); });
        ASSERT_EQ(a.missing(), s >= first && s < last);
        if (a.missing()) {
          if (above != kNoNode && !is_lost) wanted.insert(above);
          if (a.entry != kNoRecord) found.insert(whole.tree.parent[a.root]);
        } else {
          ASSERT_EQ(a.root, b.root);
          ASSERT_EQ(a.entry == kNoRecord, b.entry == kNoRecord || is_lost) << s;
        }
      }
      ASSERT_EQ(found, wanted) << chunk;
    }
  }
}

}  // namespace
}  // namespace voyager::search_tree_test
