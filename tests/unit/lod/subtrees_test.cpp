#include "runtime/lod/subtrees.h"

#include <limits>
#include <map>

#include "runtime/lod/subtree_cursor.h"
#include "runtime/lod/validate.h"
#include "tests/support/random_trees.h"
#include "tests/support/test_support.h"

namespace voyager::subtrees_test {
namespace {

constexpr uint32_t kNodes = 20000;

TEST(RandomTrees, AreSound) {
  for (const test::TreeShape shape : test::kTreeShapes)
    for (const uint32_t nodes : {1u, 2u, 3u, 10u, 1000u, 30000u})
      for (const test::Extents extents : {test::Extents::longest_side, test::Extents::any}) {
        const LodTree tree = test::random_tree(shape, nodes, nodes, extents);
        ASSERT_EQ(tree.size(), nodes);
        const auto findings = validate(tree);
        EXPECT_TRUE(findings.empty())
            << test::name_of(shape) << ' ' << nodes << ": " << findings[0];
      }
}

// visit(name, tree) for trees of every shape and of sizes around what a subtree and a
// chunk hold.
template <class Visit>
void for_trees(const Visit& visit) {
  for (const test::TreeShape shape : test::kTreeShapes)
    for (const uint32_t nodes : {1u, 2u, 4u, 30u, 31u, 32u, 33u, 61u, 62u, 1000u, kNodes})
      for (const uint32_t seed : {1u, 2u})
        visit(test::name_of(shape) + " of " + std::to_string(nodes),
              test::random_tree(shape, nodes, seed, test::Extents::any));
}

// Number of runs of the fewest that contiguous items can be packed in: every prefix
// from all shorter ones.
size_t fewest_runs(const std::vector<uint32_t>& sizes, uint32_t limit) {
  std::vector<size_t> fewest(sizes.size() + 1, std::numeric_limits<size_t>::max());
  fewest[0] = 0;
  for (size_t end = 1; end <= sizes.size(); ++end) {
    uint64_t used = 0;
    for (size_t begin = end; begin-- > 0 && (used += sizes[begin]) <= limit;)
      fewest[end] = std::min(fewest[end], fewest[begin] + 1);
  }
  return fewest.back();
}

TEST(Subtrees, NextFitPacksContiguousRunsInTheFewestChunks) {
  std::mt19937 random(1);
  for (int repeat = 0; repeat < 3000; ++repeat) {
    const uint32_t limit = 1 + random() % 40;
    std::vector<uint32_t> sizes(random() % 30);
    for (uint32_t& size : sizes) size = 1 + random() % limit;
    const auto begin = pack_runs(sizes, limit);
    ASSERT_EQ(begin.size(), fewest_runs(sizes, limit) + 1);
    ASSERT_EQ(begin.back(), sizes.size());
    for (size_t run = 0; run + 1 < begin.size(); ++run) {
      uint32_t used = 0;
      for (uint32_t i = begin[run]; i < begin[run + 1]; ++i) used += sizes[i];
      ASSERT_LT(begin[run], begin[run + 1]);
      ASSERT_LE(used, limit);
    }
  }
}

TEST(Subtrees, AreInTheFewestChunksOfTheirBytes) {
  for_trees([](const std::string& name, const LodTree& tree) {
    if (tree.size() > 1000) return;
    for (const uint32_t chunk_bytes : {kMinChunkBytes, 1500u, kDefaultChunkBytes}) {
      const Partition p = partition_tree(tree, chunk_bytes);
      std::vector<uint32_t> sizes;
      for (const Subtree& subtree : p.subtrees) sizes.push_back(32 * subtree.node_count());
      EXPECT_EQ(p.chunk_count(), fewest_runs(sizes, chunk_bytes)) << name;
      EXPECT_EQ(p.chunk_bytes, chunk_bytes);
    }
  });
}

uint32_t level_of(const Partition& p, uint32_t node) {
  return static_cast<uint32_t>(std::upper_bound(p.level_begin.begin(), p.level_begin.end(), node) -
                               p.level_begin.begin() - 1);
}

TEST(Subtrees, HoldEachNodeOnceWithItsChildrenUnderIt) {
  for_trees([](const std::string& name, const LodTree& tree) {
    SCOPED_TRACE(name);
    const Partition p = partition_tree(tree, kDefaultChunkBytes);
    std::vector<uint32_t> owners(tree.size(), 0);
    for (const Subtree& s : p.subtrees) {
      ASSERT_LE(s.node_count(), kSubtreeNodes);
      for (uint32_t slot = 0; slot < s.node_count(); ++slot) {
        ASSERT_LT(s.node(slot), tree.size());
        owners[s.node(slot)] += s.repeats(slot) ? 0 : 1;
      }
      for (uint32_t i = 1; i < s.root_count; ++i)
        ASSERT_EQ(tree.parent[s.root + i], tree.parent[s.root]);
      for (uint32_t i = 0; i < s.child_count; ++i)
        ASSERT_LT(tree.parent[s.first_child + i] - s.root, s.root_count);
      for (uint32_t i = 0; i < s.grandchild_count; ++i)
        ASSERT_LT(tree.parent[s.first_grandchild + i] - s.first_child, s.child_count);
    }
    for (uint32_t n = 0; n < tree.size(); ++n) ASSERT_EQ(owners[n], 1u) << n;
  });
}

// All nodes of a tier's upper levels have all of their children in their own tier.
TEST(Subtrees, FormTiersOfThreeLevels) {
  for_trees([](const std::string& name, const LodTree& tree) {
    SCOPED_TRACE(name);
    const Partition p = partition_tree(tree, kDefaultChunkBytes);
    ASSERT_EQ(p.tier_begin.front(), 0u);
    ASSERT_EQ(p.tier_begin.back(), p.subtrees.size());
    uint32_t level = 0;
    for (size_t tier = 0; tier + 1 < p.tier_begin.size(); ++tier) {
      const uint32_t height = tier == 0 ? p.first_tier_levels : kTierLevels;
      std::map<uint32_t, uint32_t> children;  // listed of each node of the upper levels
      for (uint32_t i = p.tier_begin[tier]; i < p.tier_begin[tier + 1]; ++i) {
        const Subtree& s = p.subtrees[i];
        ASSERT_EQ(level_of(p, s.root), level);
        for (uint32_t k = 0; k < s.root_count; ++k) children[s.root + k] += 0;
        for (uint32_t k = s.repeats_child() ? 1 : 0; k < s.child_count; ++k)
          ++children[tree.parent[s.first_child + k]];
        for (uint32_t k = 0; k < s.grandchild_count; ++k)
          ++children[tree.parent[s.first_grandchild + k]];
      }
      for (const auto& [node, listed] : children)
        ASSERT_EQ(listed,
                  level_of(p, node) + 1 < level + height ? tree.records[node].child_count : 0);
      level += height;
    }
    ASSERT_GE(level + 1, p.level_begin.size());
  });
}

TEST(Subtrees, AreOrderedAndRepeatOnlyWhatIsInSeveralRuns) {
  for_trees([](const std::string& name, const LodTree& tree) {
    SCOPED_TRACE(name);
    const Partition p = partition_tree(tree, kDefaultChunkBytes);
    for (size_t i = 0; i < p.subtrees.size(); ++i) {
      const Subtree& s = p.subtrees[i];
      if (s.repeats_root()) {
        ASSERT_EQ(s.root_count, 1u);
      }
      if (s.repeats_child()) {
        ASSERT_EQ(s.child_count, 1u);
        ASSERT_EQ(p.subtrees[i - 1].first_child, s.first_child);
        ASSERT_EQ(p.subtrees[i - 1].child_count, 1u);
      }
      if (i == 0) continue;
      const bool starts_tier =
          std::find(p.tier_begin.begin(), p.tier_begin.end(), i) != p.tier_begin.end();
      const uint32_t end = p.subtrees[i - 1].root + p.subtrees[i - 1].root_count;
      if (starts_tier) {
        ASSERT_EQ(s.root, p.level_begin[level_of(p, s.root)]);
      } else {
        ASSERT_EQ(s.root, end - (s.repeats_root() ? 1 : 0));
      }
    }
  });
}

// Subtrees below one root: as many whole children as fit, a child that does not fit
// any in runs of its own.
size_t count_subtrees(const LodTree& tree, uint32_t root, uint32_t levels) {
  size_t done = 0;
  uint32_t used = 1;
  const uint32_t children = levels > 1 ? tree.records[root].child_count : 0;
  for (uint32_t i = 0; i < children; ++i) {
    const uint32_t below = levels > 2 ? tree.records[tree.first_child[root] + i].child_count : 0;
    const bool in_runs = 2 + below > kSubtreeNodes;
    if (used > 1 && used + 1 + below > kSubtreeNodes) {
      ++done;
      used = 1;
    }
    if (in_runs)
      done += (below + kSubtreeNodes - 3) / (kSubtreeNodes - 2);
    else
      used += 1 + below;
  }
  return used > 1 || done == 0 ? done + 1 : done;
}

// Before siblings share them.
TEST(Subtrees, AreFewestOfTheThreeFirstTiers) {
  for_trees([](const std::string& name, const LodTree& tree) {
    const Partition p = partition_tree(tree, kDefaultChunkBytes);
    size_t fewest = std::numeric_limits<size_t>::max();
    for (const uint32_t first : {1u, 2u, 3u}) {
      size_t count = count_subtrees(tree, 0, first);
      for (size_t level = first; level + 1 < p.level_begin.size(); level += kTierLevels)
        for (uint32_t root = p.level_begin[level]; root < p.level_begin[level + 1]; ++root)
          count += count_subtrees(tree, root, kTierLevels);
      fewest = std::min(fewest, count);
    }
    size_t roots = 0;  // of siblings each counts as one
    for (const Subtree& s : p.subtrees) roots += s.root_count;
    EXPECT_EQ(roots, fewest) << name;
  });
}

// Of a root: what of it and below it is in its subtree's tier.
struct Below {
  uint32_t nodes = 1;
  bool deep = false;  // grandchildren
};
Below below(const LodTree& tree, uint32_t root) {
  Below below;
  for (uint32_t i = 0; i < tree.records[root].child_count; ++i) {
    const uint32_t grandchildren = tree.records[tree.first_child[root] + i].child_count;
    below.nodes += 1 + grandchildren;
    below.deep |= grandchildren != 0;
  }
  return below;
}

TEST(Subtrees, AreSharedBySiblingsOfAChunkWhileThereIsRoom) {
  size_t shared = 0, apart = 0;
  for_trees([&](const std::string& name, const LodTree& tree) {
    SCOPED_TRACE(name);
    const Partition p = partition_tree(tree, kDefaultChunkBytes);
    for (size_t chunk = 0; chunk < p.chunk_count(); ++chunk)
      for (uint32_t i = p.chunk_begin[chunk]; i < p.chunk_begin[chunk + 1]; ++i) {
        const Subtree& s = p.subtrees[i];
        shared += s.root_count > 1;
        for (uint32_t k = 1; k < s.root_count; ++k)
          ASSERT_FALSE(below(tree, s.root + k - 1).deep && below(tree, s.root + k).deep);
        if (i + 1 == p.chunk_begin[chunk + 1] || p.subtrees[i + 1].root == s.root) continue;
        const uint32_t last = s.root + s.root_count - 1, next = p.subtrees[i + 1].root;
        if (s.root == 0 || s.repeats_root() || tree.parent[last] != tree.parent[next]) continue;
        ++apart;
        ASSERT_TRUE((below(tree, last).deep && below(tree, next).deep) ||
                    s.node_count() + below(tree, next).nodes > kSubtreeNodes);
      }
  });
  EXPECT_GT(shared, 0u);
  EXPECT_GT(apart, 0u);
}

TEST(Subtrees, OfAStarOfAHundredThousandChildrenAreFull) {
  const LodTree tree = test::random_tree(test::TreeShape::star, 100001, 1);
  const Partition p = partition_tree(tree, kDefaultChunkBytes);
  EXPECT_TRUE(validate(p, tree).empty());
  EXPECT_EQ(p.subtrees.size(), (100000 + 29) / 30u);
}

TEST(Subtrees, OfAnEmptyTreeAreNone) {
  const Partition p = partition_tree(LodTree(), kDefaultChunkBytes);
  EXPECT_TRUE(p.subtrees.empty());
  EXPECT_EQ(p.chunk_count(), 0u);
  EXPECT_TRUE(validate(p, LodTree()).empty());
}

// What lets a search skip a chunk: METHOD §3 in binary32, from many centres.
TEST(Subtrees, AnEntryHullIsNeverSmallerThanWhatItCovers) {
  std::mt19937 random(5);
  for_trees([&](const std::string& name, const LodTree& tree) {
    const Partition p = partition_tree(tree, kDefaultChunkBytes);
    for (int i = 0; i < 5; ++i) {
      const Vec3f c{300 * test::unit(random) - 150, 300 * test::unit(random) - 150,
                    300 * test::unit(random) - 150};
      for (size_t chunk = 0; chunk < p.chunk_count(); ++chunk)
        for (uint32_t s = p.chunk_begin[chunk]; s < p.chunk_begin[chunk + 1]; ++s) {
          const uint32_t parent = tree.parent[p.subtrees[s].first_owned()];
          const float size = parent == kNoNode ? std::numeric_limits<float>::infinity()
                                               : tree.screen_size(parent, c);
          ASSERT_GE(p.chunk_hull[chunk].screen_size(c), size) << name;
        }
    }
  });
}

TEST(Subtrees, ThatAreSoundPassTheValidator) {
  for_trees([](const std::string& name, const LodTree& tree) {
    for (const uint32_t chunk_bytes : {kMinChunkBytes, kDefaultChunkBytes, kMaxChunkBytes}) {
      const auto findings = validate(partition_tree(tree, chunk_bytes), tree);
      EXPECT_TRUE(findings.empty()) << name << ": " << findings[0];
    }
  });
}

template <class Edit>
void expect_caught(const Edit& edit) {
  for (const test::TreeShape shape : test::kTreeShapes) {
    const LodTree tree = test::random_tree(shape, 3000, 3);
    Partition p = partition_tree(tree, kDefaultChunkBytes);
    edit(p);
    EXPECT_FALSE(validate(p, tree).empty()) << test::name_of(shape);
  }
}

TEST(Subtrees, ThatAreNotAreCaughtByTheValidator) {
  expect_caught([](Partition& p) { p.subtrees[5].root += 1; });
  expect_caught([](Partition& p) { p.subtrees[5].root = 0xfffffff0; });
  expect_caught([](Partition& p) {
    Repeats& repeated = p.subtrees[5].repeated;
    repeated = repeated == Repeats::nothing ? Repeats::root : Repeats::nothing;
  });
  expect_caught([](Partition& p) { p.subtrees[5].root_count += 1; });
  expect_caught([](Partition& p) { p.subtrees[5].root_count = 0; });
  expect_caught([](Partition& p) { p.subtrees[5].child_count += 1; });
  expect_caught([](Partition& p) { p.subtrees[5].grandchild_count = 255; });
  expect_caught([](Partition& p) { p.subtrees.pop_back(); });
  expect_caught([](Partition& p) { std::swap(p.subtrees[5], p.subtrees[6]); });
  expect_caught([](Partition& p) { p.level_begin[1] += 1; });
  expect_caught([](Partition& p) { p.level_begin.pop_back(); });
  expect_caught([](Partition& p) { p.tier_begin.back() -= 1; });
  expect_caught([](Partition& p) { p.first_tier_levels = 4; });
  expect_caught([](Partition& p) { p.chunk_bytes = 1024; });
  expect_caught([](Partition& p) { p.chunk_begin[1] = p.chunk_begin[2]; });
  expect_caught([](Partition& p) { p.chunk_hull[0].extent = 1e9f; });
  expect_caught([](Partition& p) { p.chunk_hull.pop_back(); });
}

// Counts and records that belong to no tree are named, never followed.
TEST(SubtreeCursor, SurvivesNoise) {
  std::mt19937 random(6);
  const LodTree tree = test::random_tree(test::TreeShape::mixture, 2000, 4);
  const Partition p = partition_tree(tree, kDefaultChunkBytes);
  size_t faults = 0;
  for (int repeat = 0; repeat < 2000; ++repeat) {
    SubtreeCursor cursor(tiers_of(p));
    for (int step = 0; step < 40; ++step) {
      std::vector<NodeRecord> records(512);
      for (NodeRecord& r : records) r.child_count = random() % 3 ? random() % 6 : random();
      Subtree out{};
      const SubtreeCounts counts{static_cast<uint8_t>(random() % 4 ? 1 : random() % 8),
                                 static_cast<uint8_t>(random() % 9),
                                 static_cast<uint8_t>(random() % (random() % 8 ? 20 : 256))};
      if (cursor.take(counts, records.data(), out)) {
        ++faults;
        break;
      }
      for (uint32_t slot = 0; slot < out.node_count(); ++slot)
        ASSERT_LT(out.node(slot), tree.size());
    }
  }
  EXPECT_GT(faults, 1500u);
}

// A chunk has no more subtrees than nodes.
TEST(SubtreeCursor, EverySubtreeOwnsANode) {
  const uint32_t levels[] = {0, 1, 2, 62}, tiers[] = {0, 4};
  SubtreeCursor cursor({3, levels, tiers});
  NodeRecord records[kSubtreeNodes]{};
  Subtree out{};
  records[0].child_count = 1, records[1].child_count = 60;
  ASSERT_EQ(cursor.take({1, 1, 29}, records, out), nullptr);
  records[1].child_count = 0;
  EXPECT_STREQ(cursor.take({1, 1, 0}, records, out), "no node of its own");
}

// From any place at which a subtree starts, the rest is as from the first.
TEST(SubtreeCursor, GoesOnFromAnyPlace) {
  for (const test::TreeShape shape : test::kTreeShapes) {
    const LodTree tree = test::random_tree(shape, 2000, 5);
    const Partition p = partition_tree(tree, kDefaultChunkBytes);
    const auto take = [&](SubtreeCursor& cursor) {
      const Subtree& from = p.subtrees[cursor.subtree()];
      NodeRecord records[kSubtreeNodes];
      for (uint32_t slot = 0; slot < from.node_count(); ++slot)
        records[slot] = tree.records[from.node(slot)];
      Subtree to{};
      EXPECT_EQ(cursor.take(counts_of(from), records, to), nullptr);
      EXPECT_EQ(to, from);
    };
    SubtreeCursor cursor(tiers_of(p));
    while (!cursor.at_end()) {
      SubtreeCursor other(tiers_of(p));
      ASSERT_TRUE(other.move_to(cursor.subtree(), cursor.place()));
      EXPECT_FALSE(other.move_to(cursor.subtree() + 100000, cursor.place()));
      take(cursor);
      take(other);
      ASSERT_EQ(cursor.place(), other.place());
    }
    EXPECT_EQ(cursor.place(), SubtreePlace::end_of(tiers_of(p)));
  }
}

}  // namespace
}  // namespace voyager::subtrees_test
