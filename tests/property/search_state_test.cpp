// What the searches keep: from frame to frame, beside each other, and after damage.
#include "tests/support/search_rig.h"

namespace voyager::search_state_test {
namespace {

using test::SearchRig;
using test::TreeShape;

constexpr CutQuery kHere{{30, 4, -12}, 0.05f};

TEST(SearchState, StandingStillCostsNothingAndDriftsNowhere) {
  SearchRig rig(test::random_tree(TreeShape::four_way, 8000, 1));
  ASSERT_TRUE(rig.agree(kHere));
  uint64_t visited = 0, tested = 0;
  for (int frame = 0; frame < 100000; ++frame) {
    rig.temporal.run(kHere, Search::temporal, rig.workers);
    visited += rig.temporal.stats().subtrees_visited;
    tested += rig.temporal.stats().nodes_tested;
  }
  EXPECT_EQ(visited, 0u);
  EXPECT_EQ(tested, 0u);
  for (int frame = 0; frame < 300; ++frame)
    rig.temporal_visit.run(kHere, Search::temporal_visit, rig.workers);
  ASSERT_TRUE(rig.agree(kHere));
  ASSERT_TRUE(rig.agree({{30, 4, -11.9f}, 0.05f}));
}

// A place and back, over and over: what was noted at the one serves at the other.
TEST(SearchState, GoingToAndFroForgetsNothing) {
  SearchRig rig(test::random_tree(TreeShape::four_way, 8000, 2));
  for (int frame = 0; frame < 600; ++frame)
    ASSERT_TRUE(rig.agree({{frame % 2 == 0 ? 30.0f : 30.01f, 4, -12}, 0.05f})) << frame;
}

TEST(SearchState, OneStateServesEverySearchInAnyOrder) {
  SearchRig rig(test::random_tree(TreeShape::mixture, 5000, 3));
  PartitionedSearch search(rig.search_tree);
  std::mt19937 random(3);
  constexpr Search kKinds[] = {Search::streaming, Search::temporal, Search::temporal_visit};
  CutQuery query = kHere;
  for (int frame = 0; frame < 400; ++frame) {
    if (random() % 3 != 0) query.centre.x += test::unit(random) - 0.5f;
    if (random() % 20 == 0) query.target_size = 0.01f + 0.1f * test::unit(random);
    if (random() % 25 == 0) search.forget();
    search.run(query, kKinds[random() % 3], rig.workers);
    rig.oracle.run(rig.tree, {}, query, rig.workers);
    ASSERT_EQ(search.cut(), rig.oracle.cut()) << frame;
  }
}

// As a view finds it that has not drawn meanwhile: all but the top has gone and come again.
TEST(SearchState, WhatWasUnlinkedAndLinkedAgainGoesOn) {
  for (const TreeShape shape : {TreeShape::four_way, TreeShape::mixture}) {
    SearchRig rig(test::random_tree(shape, 5000, 5));
    std::vector<uint32_t> all, below;
    for (uint32_t s = 0; s < rig.search_tree.subtree_count(); ++s) all.push_back(s);
    below.assign(all.begin() + rig.search_tree.tier_begin[1], all.end());
    for (int frame = 0; frame < 20; ++frame) {
      ASSERT_TRUE(rig.agree({{30, 4, -12 + 0.5f * static_cast<float>(frame / 2)}, 0.05f}));
      for (PartitionedSearch* search : {&rig.streaming, &rig.temporal, &rig.temporal_visit})
        search->relink(below, all);
    }
  }
}

TEST(SearchState, ViewsOfOneSceneAreIndependent) {
  SearchRig rig(test::random_tree(TreeShape::four_way, 8000, 4));
  PartitionedSearch alone(rig.search_tree), a(rig.search_tree), b(rig.search_tree);
  for (int frame = 0; frame < 100; ++frame) {
    const float way = 0.05f * static_cast<float>(frame);
    const CutQuery query{{30 - way, 4, way}, 0.05f};
    alone.run(query, Search::temporal, rig.workers);
    a.run(query, Search::temporal, rig.workers);
    b.run({{-50, way, 3}, 0.03f}, Search::temporal, rig.workers);
    ASSERT_EQ(a.cut(), alone.cut());
    ASSERT_EQ(a.stats().nodes_tested, alone.stats().nodes_tested);
    rig.oracle.run(rig.tree, {}, {{-50, way, 3}, 0.03f}, rig.workers);
    ASSERT_EQ(b.cut(), rig.oracle.cut());
  }
}

uint64_t nodes_of_subtrees_with_cut(const SearchRig& rig) {
  uint64_t nodes = 0;
  for (uint32_t s = 0; s < rig.partition.subtrees.size(); ++s)
    if (rig.temporal_visit.cut_slots(s) != 0) nodes += rig.partition.subtrees[s].node_count();
  return nodes;
}

TEST(SearchState, VisitingTheCutTestsAtMostTwiceTheNodesOfItsSubtrees) {
  SearchRig rig(test::random_tree(TreeShape::four_way, 50000, 5));
  for (int frame = 0; frame < 60; ++frame) {
    ASSERT_TRUE(rig.agree({{60 - 0.05f * static_cast<float>(frame), 4, 10}, 0.1f}));
    if (frame == 0) continue;
    EXPECT_EQ(rig.temporal_visit.stats().ran, Search::temporal_visit);
    EXPECT_LE(rig.temporal_visit.stats().nodes_tested, 2 * nodes_of_subtrees_with_cut(rig));
  }
}

TEST(SearchState, ATeleportFallsBackToStreamingAndAStepDoesNot) {
  SearchRig rig(test::random_tree(TreeShape::four_way, 50000, 6));
  const auto ran = [&](const CutQuery& query) {
    EXPECT_TRUE(rig.agree(query));
    return rig.temporal.stats().ran;
  };
  EXPECT_EQ(ran({{30, 0, 0}, 0.05f}), Search::streaming);  // the first frame
  EXPECT_EQ(ran({{30.05f, 0, 0}, 0.05f}), Search::temporal);
  EXPECT_EQ(ran({{-60, 40, 20}, 0.05f}), Search::streaming);
  EXPECT_EQ(ran({{-60, 40.05f, 20}, 0.05f}), Search::temporal);
  EXPECT_EQ(ran({{-60, 40.05f, 20}, 0.01f}), Search::streaming);
}

TEST(SearchState, StreamingSkipsChunksAndStopsWhereTheCutIsClosed) {
  SearchRig rig(test::random_tree(TreeShape::four_way, 100000, 7), kMinChunkBytes);
  const auto read = [&](float target) {
    EXPECT_TRUE(rig.agree({{120, 0, 0}, target}));
    EXPECT_EQ(rig.streaming.stats().ran, Search::streaming);
    return rig.streaming.stats().chunks_read;
  };
  EXPECT_EQ(read(1e20f), 1u);
  const uint64_t few = read(1.0f), more = read(0.2f), all = read(1e-30f);
  EXPECT_LT(few * 20, all);
  EXPECT_LT(few, more);
  EXPECT_LT(more, all);
  EXPECT_LE(all, rig.search_tree.chunk_count);
}

// One chunk of a tree, gone: what may not be read is poisoned.
struct Damaged {
  LodTree tree;
  Partition partition;
  std::vector<SubtreeRange> subtrees;
  std::vector<MissingNodes> nodes;
};

Damaged without_chunks(const SearchRig& rig, const std::vector<uint32_t>& chunks) {
  Damaged d{rig.tree, rig.partition, {}, {}};
  for (const uint32_t chunk : chunks) {
    const uint32_t first = d.partition.chunk_begin[chunk],
                   last = d.partition.chunk_begin[chunk + 1];
    const Subtree& lost = d.partition.subtrees[first];
    d.subtrees.push_back({first, last, lost.root, lost.repeats_root()});
    for (uint32_t s = first; s < last; ++s) {
      Subtree& subtree = d.partition.subtrees[s];
      for (uint32_t slot = 0; slot < subtree.node_count(); ++slot)
        if (!subtree.repeats(slot)) d.nodes.push_back({subtree.node(slot), 1});
      subtree = {kNoNode, 0, 0, 1, 0, 0, Repeats::nothing};
    }
  }
  std::sort(d.nodes.begin(), d.nodes.end(),
            [](const MissingNodes& a, const MissingNodes& b) { return a.first < b.first; });
  for (const MissingNodes& m : d.nodes) {
    const uint32_t children = d.tree.records[m.first].child_count;
    for (uint32_t i = 0; i < children; ++i)
      d.tree.parent[d.tree.first_child[m.first] + i] = kNoNode;
    d.tree.records[m.first] = {{NAN, NAN, NAN}, NAN, {NAN, NAN, NAN}, 0};
    d.tree.first_child[m.first] = kNoNode;
  }
  return d;
}

// `exact`: no chunk holds a further run of a subtree that is split, which a frame may
// then seem to need without reading it.
void expect_damage_found(SearchRig& rig, const std::vector<uint32_t>& chunks, bool exact) {
  const Damaged damaged = without_chunks(rig, chunks);
  const SearchTree search_tree =
      make_search_tree(damaged.tree, damaged.partition, damaged.subtrees, rig.workers);
  PartitionedSearch searches[] = {PartitionedSearch(search_tree), PartitionedSearch(search_tree),
                                  PartitionedSearch(search_tree)};
  constexpr Search kKinds[] = {Search::streaming, Search::temporal, Search::temporal_visit};
  std::mt19937 random(8);
  for (int frame = 0; frame < 40; ++frame) {
    const CutQuery query{{90 * test::unit(random), 10, 0}, frame % 3 == 0 ? 0.1f : 1.0f};
    rig.oracle.run(damaged.tree, damaged.nodes, query, rig.workers);
    for (int k = 0; k < 3; ++k) {
      searches[k].run(query, kKinds[k], rig.workers);
      const uint32_t found = searches[k].needed_missing();
      if (exact) {
        ASSERT_EQ(found, rig.oracle.needed_missing()) << frame;
      } else if (rig.oracle.needed_missing() != kNoNode) {
        ASSERT_NE(found, kNoNode) << frame;
      }
      if (found == kNoNode) {
        ASSERT_EQ(searches[k].cut(), rig.oracle.cut()) << frame;
      }
    }
  }
}

TEST(SearchState, MissingSubtreesAreNamedWhereTheCutNeedsThem) {
  SearchRig rig(test::random_tree(TreeShape::four_way, 5000, 8), kMinChunkBytes);
  const auto last = static_cast<uint32_t>(rig.partition.chunk_count()) - 1;
  for (uint32_t chunk = 0; chunk <= last; chunk += 3)
    ASSERT_NO_FATAL_FAILURE(expect_damage_found(rig, {chunk}, true)) << chunk;
  ASSERT_NO_FATAL_FAILURE(expect_damage_found(rig, {1, 2, 3, 7, last}, true));
  ASSERT_NO_FATAL_FAILURE(expect_damage_found(rig, {last - 1, last}, true));
}

TEST(SearchState, MissingSubtreesOfTreesWithLargeFamilies) {
  for (const TreeShape shape : {TreeShape::star, TreeShape::star_of_stars, TreeShape::uneven}) {
    SearchRig rig(test::random_tree(shape, 3000, 9), kMinChunkBytes);
    const auto last = static_cast<uint32_t>(rig.partition.chunk_count()) - 1;
    for (uint32_t chunk = 0; chunk <= last; chunk += 5)
      ASSERT_NO_FATAL_FAILURE(expect_damage_found(rig, {chunk}, false))
          << test::name_of(shape) << ' ' << chunk;
    ASSERT_NO_FATAL_FAILURE(expect_damage_found(rig, {1, 2, last}, false));
  }
}

// Refuses the allocation that it is told to.
class FailingResource final : public std::pmr::memory_resource {
 public:
  int allocations = 0, failing = -1;

 private:
  void* do_allocate(size_t bytes, size_t alignment) override {
    if (allocations++ == failing) throw std::bad_alloc();
    return std::pmr::new_delete_resource()->allocate(bytes, alignment);
  }
  void do_deallocate(void* p, size_t bytes, size_t alignment) override {
    std::pmr::new_delete_resource()->deallocate(p, bytes, alignment);
  }
  bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }
};

TEST(SearchState, AllocatesNothingOnceWarmAndRecoversWhereItMay) {
  SearchRig rig(test::random_tree(TreeShape::four_way, 8000, 10));
  FailingResource memory;
  PartitionedSearch search(rig.search_tree, &memory);
  memory.failing = memory.allocations;
  const CutQuery fine{{30, 4, -12}, 1e-6f};
  EXPECT_THROW(search.run(fine, Search::temporal, rig.workers), std::bad_alloc);
  search.run(fine, Search::temporal, rig.workers);
  rig.oracle.run(rig.tree, {}, fine, rig.workers);
  ASSERT_EQ(search.cut(), rig.oracle.cut());
  int warm = 0;
  for (const bool first : {true, false}) {
    for (const float target : {1.0f, 0.1f, 0.1001f, 1e-3f, 10.0f}) {
      const CutQuery query{{30, 4, -12}, target};
      for (const Search kind : {Search::temporal, Search::temporal_visit, Search::streaming})
        search.run(query, kind, rig.workers);
      rig.oracle.run(rig.tree, {}, query, rig.workers);
      ASSERT_EQ(search.cut(), rig.oracle.cut());
    }
    if (first) warm = memory.allocations;
  }
  EXPECT_EQ(memory.allocations, warm);
}

}  // namespace
}  // namespace voyager::search_state_test
