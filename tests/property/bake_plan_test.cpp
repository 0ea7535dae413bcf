// The plan of a bake in parts is the partition of the whole tree, whatever shapes the
// cells have.
#include "runtime/bake/plan.h"

#include <set>

#include "tests/support/random_layouts.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"

namespace voyager::bake_plan_test {
namespace {

struct Cells {
  uint32_t level;
  std::vector<TreeLayout> layouts;
};

// All of one size, but for some that end on the first level that may have leaves.
Cells random_cells(uint32_t level, uint32_t leaves, uint32_t seed) {
  Cells cells{level, {}};
  for (uint32_t i = 0; i < 1u << (2 * level); ++i)
    cells.layouts.push_back(test::random_cell((i + seed) % 7 == 0 ? 4 : leaves, 1000 * seed + i));
  return cells;
}

BakePlan plan_of(const Cells& cells, uint32_t chunk_bytes) {
  Workers workers(2);
  return BakePlan(
      cells.level, chunk_bytes, [&](uint32_t cell) { return cells.layouts.at(cell).child_count; },
      workers);
}

LodTree tree_of(const Cells& cells) {
  const TreeLayout whole = test::joined(cells.layouts);
  return test::linked_tree({whole.child_count.begin(), whole.child_count.end()});
}

// Before each subtree.
std::vector<SubtreePlace> places_of(const LodTree& tree, const Partition& partition) {
  SubtreeCursor cursor(tiers_of(partition));
  std::vector<SubtreePlace> places;
  for (const Subtree& subtree : partition.subtrees) {
    places.push_back(cursor.place());
    std::vector<NodeRecord> records;
    for (uint32_t slot = 0; slot < subtree.node_count(); ++slot)
      records.push_back(tree.records[subtree.node(slot)]);
    Subtree taken;
    EXPECT_EQ(cursor.take(counts_of(subtree), records.data(), taken), nullptr);
  }
  return places;
}

// Of each node; kTop above the cells.
std::vector<uint32_t> cells_of(const LodTree& tree, const Partition& partition, uint32_t level) {
  std::vector<uint32_t> cell(tree.size(), BakePlan::kTop);
  for (uint32_t n = partition.level_begin[level]; n < tree.size(); ++n)
    cell[n] = n < partition.level_begin[level + 1] ? n - partition.level_begin[level]
                                                   : cell[tree.parent[n]];
  return cell;
}

void expect_chunks_before(const Segment& segment, const Partition& partition) {
  uint32_t chunks = 0, bytes = 0;
  for (uint32_t i = 0; i < segment.first_subtree; ++i) {
    if (i == partition.chunk_begin[chunks]) ++chunks, bytes = 0;
    bytes += partition.subtrees[i].node_count() * static_cast<uint32_t>(sizeof(NodeRecord));
  }
  EXPECT_EQ(segment.chunks_before, chunks);
  EXPECT_EQ(segment.open_bytes, bytes);
}

void expect_segments(const BakePlan& plan, const LodTree& tree, const Partition& partition) {
  const std::vector<SubtreePlace> places = places_of(tree, partition);
  const std::vector<uint32_t> cell = cells_of(tree, partition, plan.cell_level());
  std::vector<Segment> segments;
  for (uint32_t tier = 0; tier < plan.tiers().tier_count(); ++tier) {
    ASSERT_EQ(plan.segments(tier).front().first_subtree, partition.tier_begin[tier]);
    segments.insert(segments.end(), plan.segments(tier).begin(), plan.segments(tier).end());
  }
  for (size_t i = 0; i < segments.size(); ++i) {
    const uint32_t begin = segments[i].first_subtree;
    const size_t end =
        i + 1 < segments.size() ? segments[i + 1].first_subtree : partition.subtrees.size();
    if (begin == end) continue;  // of a cell that has no such level
    EXPECT_EQ(segments[i].place, places[begin]);
    expect_chunks_before(segments[i], partition);
    for (size_t s = begin; s < end; ++s)
      ASSERT_EQ(cell[partition.subtrees[s].root], segments[i].cell) << "subtree " << s;
  }
}

TEST(BakePlan, IsThePartitionOfTheTreeOverCellsOfEveryShape) {
  std::set<uint32_t> first_tiers;
  for (uint32_t seed = 0; seed < 24; ++seed) {
    const Cells cells = random_cells(1 + seed % 3, 40 + 60 * (seed / 3), seed);
    const LodTree tree = tree_of(cells);
    for (const uint32_t chunk_bytes : {kMinChunkBytes, kDefaultChunkBytes, kMaxChunkBytes}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(chunk_bytes));
      const Partition partition = partition_tree(tree, chunk_bytes);
      const BakePlan plan = plan_of(cells, chunk_bytes);
      ASSERT_EQ(plan.tiers().first_tier_levels, partition.first_tier_levels);
      ASSERT_TRUE(std::ranges::equal(plan.tiers().level_begin, partition.level_begin));
      ASSERT_TRUE(std::ranges::equal(plan.tiers().tier_begin, partition.tier_begin));
      EXPECT_EQ(plan.chunk_count(), partition.chunk_count());
      expect_segments(plan, tree, partition);
      first_tiers.insert(partition.first_tier_levels);
    }
  }
  EXPECT_EQ(first_tiers.size(), 3u) << "not every first tier was tried";
}

TEST(BakePlan, RefusesCellsWhoseSubtreesItCouldNotKnow) {
  const TreeLayout sound = test::random_cell(64, 1);
  const auto code_with = [&](const std::vector<uint8_t>& child_count) {
    return test::error_code([&] {
      plan_of({1, {sound, sound, {child_count, {}, {}, {}}, sound}}, kDefaultChunkBytes);
    });
  };
  EXPECT_EQ(code_with({}), ErrorCode::internal);
  EXPECT_EQ(code_with({0}), ErrorCode::internal);
  EXPECT_EQ(code_with({2, 0, 2, 0, 0}), ErrorCode::internal);        // a leaf on level 1
  EXPECT_EQ(code_with({1, 5, 0, 0, 0, 0, 0}), ErrorCode::internal);  // five children
  EXPECT_EQ(code_with({1, 2, 0}), ErrorCode::internal);              // a node is missing
  EXPECT_EQ(code_with({1, 1, 0, 0}), ErrorCode::internal);           // one too many
  EXPECT_NO_THROW(plan_of({1, {sound, sound, {{1, 1, 0}, {}, {}, {}}, sound}}, kDefaultChunkBytes));
}

}  // namespace
}  // namespace voyager::bake_plan_test
