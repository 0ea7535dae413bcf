// Streaming, temporal and temporal_visit give the exhaustive search's cut and weights,
// to the bit: any tree, any place, any granularity, in any order.
#include <cstdlib>

#include "tests/support/search_rig.h"
#include "tests/support/test_support.h"

namespace voyager::search_equality_test {
namespace {

using test::kInfinity;
using test::SearchRig;

// In an order that makes each query a teleport or a new τ* for the one before.
std::vector<CutQuery> edge_queries(const LodTree& tree, std::mt19937& random, size_t nodes) {
  std::vector<CutQuery> all;
  for (const Vec3f& c : test::edge_centres(tree, random, nodes)) {
    for (const float target : {1e-30f, 1e-3f, 0.01f, 0.1f, 0.5f, 5.0f, 1e20f, kInfinity})
      all.push_back({c, target});
    for (int i = 0; i < 4; ++i) all.push_back({c, test::edge_target(tree, c, random)});
  }
  std::shuffle(all.begin(), all.end(), random);
  return all;
}

void expect_agreement(const LodTree& tree, uint32_t chunk_bytes, uint32_t seed, size_t nodes) {
  std::mt19937 random(seed);
  SearchRig rig(tree, chunk_bytes);
  for (const CutQuery& query : edge_queries(tree, random, nodes))
    ASSERT_TRUE(rig.agree(query)) << "centre " << query.centre.x << ' ' << query.centre.y << ' '
                                  << query.centre.z;
}

void expect_agreement_on_all_shapes(uint32_t nodes, size_t places) {
  for (const test::TreeShape shape : test::kTreeShapes)
    for (const test::Extents extents : {test::Extents::longest_side, test::Extents::any})
      for (const uint32_t chunk_bytes : {kMinChunkBytes, kDefaultChunkBytes}) {
        SCOPED_TRACE(test::name_of(shape) + ", " + std::to_string(nodes) + " nodes, chunks of " +
                     std::to_string(chunk_bytes));
        ASSERT_NO_FATAL_FAILURE(expect_agreement(test::random_tree(shape, nodes, nodes, extents),
                                                 chunk_bytes, nodes, places));
      }
}

TEST(SearchEquality, SmallTreesOfEveryShape) {
  for (const uint32_t nodes : {1u, 2u, 3u, 4u, 5u, 7u, 13u, 31u, 32u, 33u, 100u})
    expect_agreement_on_all_shapes(nodes, 1);
}

TEST(SearchEquality, TreesOfEveryShape) {
  expect_agreement_on_all_shapes(3000, 2);
}

// Boxes that are small beside their coordinates, astride the planes where rounded ones change.
TEST(SearchEquality, TreesFarFromTheOrigin) {
  for (const test::TreeShape shape : test::kTreeShapes)
    ASSERT_NO_FATAL_FAILURE(
        expect_agreement(test::moved(test::random_tree(shape, 2000, 7), 0.02f, {256, 1024, -64}),
                         kMinChunkBytes, 7, 2));
}

TEST(SearchEquality, LargeTrees) {
  for (const test::TreeShape shape :
       {test::TreeShape::four_way, test::TreeShape::star, test::TreeShape::mixture})
    ASSERT_NO_FATAL_FAILURE(
        expect_agreement(test::random_tree(shape, 100000, 3), kDefaultChunkBytes, 3, 1));
}

TEST(SearchEquality, AChainOfAHundredThousandAndAFamilyOfAMillion) {
  for (const auto& [shape, nodes] :
       {std::pair(test::TreeShape::chain, 100000u), std::pair(test::TreeShape::star, 1000001u)}) {
    SearchRig rig(test::random_tree(shape, nodes, 1));
    for (const CutQuery& query : {CutQuery{{30, 4, -12}, 0.05f},
                                  {{30, 4, -12}, 1e-6f},
                                  {{0, 0, 0}, 10},
                                  {{1000, 4, -12}, 0.5f},
                                  {{1000.1f, 4, -12}, 0.5f}})
      ASSERT_TRUE(rig.agree(query)) << test::name_of(shape);
  }
}

// Minutes: VOYAGER_LARGE_TREES=1.
TEST(SearchEquality, TreesOfAMillionNodes) {
  if (std::getenv("VOYAGER_LARGE_TREES") == nullptr) GTEST_SKIP() << "takes minutes";
  for (const test::TreeShape shape : test::kTreeShapes) {
    SCOPED_TRACE(test::name_of(shape));
    ASSERT_NO_FATAL_FAILURE(
        expect_agreement(test::random_tree(shape, 1000000, 4), kDefaultChunkBytes, 4, 2));
  }
}

// An extent may be infinite: what a node of a .hier file without a size says.
TEST(SearchEquality, InfiniteExtents) {
  LodTree tree = test::random_tree(test::TreeShape::four_way, 3000, 5);
  for (uint32_t n = 0; n < 40; ++n) tree.records[n].extent = kInfinity;
  expect_agreement(tree, kDefaultChunkBytes, 5, 3);
}

TEST(SearchEquality, AnEmptyTreeHasAnEmptyCut) {
  SearchRig rig{LodTree()};
  EXPECT_TRUE(rig.agree({{0, 0, 0}, 1.0f}));
  EXPECT_TRUE(rig.agree({{1, 0, 0}, 1.0f}));
  EXPECT_EQ(rig.temporal.stats().nodes_tested, 0u);
  EXPECT_EQ(rig.temporal.needed_missing(), kNoNode);
}

// From one node to every leaf and back.
TEST(SearchEquality, CutsOfEverySize) {
  SearchRig rig(test::random_tree(test::TreeShape::four_way, 20000, 6));
  const Vec3f c{150, 20, -30};
  std::vector<float> targets = {kInfinity};
  for (float target = 100.0f; target > 1e-4f; target *= 0.8f) targets.push_back(target);
  targets.push_back(1e-30f);
  size_t least = SIZE_MAX, most = 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (const float target : targets) {
      ASSERT_TRUE(rig.agree({c, target}));
      least = std::min(least, rig.temporal.cut().size());
      most = std::max(most, rig.temporal.cut().size());
    }
    std::reverse(targets.begin(), targets.end());
  }
  const auto leaves = std::count_if(rig.tree.records.begin(), rig.tree.records.end(),
                                    [](const NodeRecord& r) { return r.child_count == 0; });
  EXPECT_EQ(least, 1u);
  EXPECT_EQ(most, static_cast<size_t>(leaves));
}

TEST(SearchEquality, ResultsDoNotDependOnThreads) {
  const LodTree tree = test::random_tree(test::TreeShape::mixture, 30000, 7);
  SearchRig one(tree, kMinChunkBytes, 1), many(tree, kMinChunkBytes, 5);
  std::mt19937 random(7);
  Vec3f c{40, 0, 0};
  for (int i = 0; i < 60; ++i) {
    for (int axis = 0; axis < 3; ++axis) c[axis] += 4 * test::unit(random) - 2;
    const CutQuery query{c, i % 7 == 0 ? 0.02f : 0.05f};
    ASSERT_TRUE(one.agree(query));
    ASSERT_TRUE(many.agree(query));
    for (auto search : {&SearchRig::streaming, &SearchRig::temporal, &SearchRig::temporal_visit}) {
      const SearchStats &a = (one.*search).stats(), &b = (many.*search).stats();
      ASSERT_EQ(a.ran, b.ran);
      ASSERT_EQ(a.nodes_tested, b.nodes_tested);
      ASSERT_EQ(a.subtrees_visited, b.subtrees_visited);
      ASSERT_EQ(a.chunks_read, b.chunks_read);
      ASSERT_EQ(a.bytes_read, b.bytes_read);
    }
  }
}

}  // namespace
}  // namespace voyager::search_equality_test
