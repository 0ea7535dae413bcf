// How much room search records take, as the directory tells it and as chunks have it.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <random>
#include <set>

#include "runtime/stream/scene_stream.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"

namespace voyager::record_room_test {
namespace {

using test::TreeShape;

uint32_t records_of(const SceneFile& file, uint32_t chunk) {
  const Tiers tiers = file.tiers();
  return static_cast<uint32_t>(
      stage_chunk(file.read_chunk(chunk), chunk, tiers, file.name()).records.size());
}

TEST(RecordRoom, BoundsWhatEveryChunkTakes) {
  for (const TreeShape shape : test::kTreeShapes)
    for (const uint32_t chunk_bytes : {kMinChunkBytes, kDefaultChunkBytes}) {
      SCOPED_TRACE(test::name_of(shape));
      const test::Bytes bytes = test::scene_bytes(test::baked_of(test::random_tree(shape, 6000, 3)),
                                                  Quality::compact, 0, chunk_bytes);
      const SceneFile file(test::source_of(bytes));
      const RecordRoom room(file);
      const auto chunks = static_cast<uint32_t>(file.chunks().size());
      uint64_t taken = 0;
      for (uint32_t chunk = 0; chunk < chunks; ++chunk) {
        const uint32_t blocks = record_blocks(records_of(file, chunk));
        EXPECT_LE(blocks, room.most_blocks(chunk));
        EXPECT_LE(room.most_blocks(chunk), room.most_blocks());
        taken += blocks;
      }
      EXPECT_GE(room.of(chunks).blocks, taken);
    }
}

// A tree of which few nodes are interior takes less than a record for each node.
TEST(RecordRoom, IsLessThanARecordANode) {
  const test::Bytes bytes =
      test::scene_bytes(test::baked_of(test::random_tree(TreeShape::eight_way, 20000, 4)),
                        Quality::compact, 0, kDefaultChunkBytes);
  const SceneFile file(test::source_of(bytes));
  const auto chunks = static_cast<uint32_t>(file.chunks().size());
  const PoolRoom room = RecordRoom(file).of(chunks);
  EXPECT_LT(room.blocks * kRecordBlock, file.info().node_count / 3);
}

TEST(RecordRoom, GrowsWithTheSlotsAndHoldsWhatIsPinned) {
  const test::Bytes bytes =
      test::scene_bytes(test::baked_of(test::random_tree(TreeShape::four_way, 20000, 5)),
                        Quality::compact, 0, kMinChunkBytes);
  const SceneFile file(test::source_of(bytes));
  const RecordRoom room(file);
  const auto chunks = static_cast<uint32_t>(file.chunks().size());
  const uint32_t all = room.of(chunks).blocks;
  uint32_t before = 0;
  for (uint32_t slots = SceneStream::top_chunks(file); slots <= chunks; ++slots) {
    const uint32_t blocks = room.of(slots).blocks;
    EXPECT_GE(blocks, before);
    const uint32_t pinned = SceneStream::pinned_chunks(file, slots);
    EXPECT_GE(blocks, std::min(all, (pinned + 1) * room.most_blocks()));
    before = blocks;
  }
}

// Whichever chunks those are.
TEST(RecordRoom, HasPagesForTheSubtreesOfAnySoManyChunks) {
  for (const TreeShape shape : test::kTreeShapes) {
    SCOPED_TRACE(test::name_of(shape));
    const test::Bytes bytes = test::scene_bytes(test::baked_of(test::random_tree(shape, 6000, 3)),
                                                Quality::compact, 0, kMinChunkBytes);
    const SceneFile file(test::source_of(bytes));
    const RecordRoom room(file);
    const auto chunks = static_cast<uint32_t>(file.chunks().size());
    std::vector<uint32_t> order(chunks);
    std::iota(order.begin(), order.end(), 0u);
    const auto expect_room = [&] {
      std::set<uint32_t> pages;
      uint32_t before = 0;
      for (uint32_t some = 1; some <= chunks; ++some) {
        const ChunkEntry& chunk = file.chunks()[order[some - 1]];
        for (uint32_t s = 0; s < chunk.subtree_count; ++s)
          pages.insert((chunk.first_subtree + s) / kPageSubtrees);
        if (some < SceneStream::top_chunks(file)) continue;
        ASSERT_GE(room.of(some).pages, pages.size());
        ASSERT_GE(room.of(some).pages, before);
        before = room.of(some).pages;
      }
    };
    std::shuffle(order.begin(), order.end(), std::mt19937(5));
    expect_room();
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
      return file.chunks()[a].subtree_count > file.chunks()[b].subtree_count;
    });
    expect_room();
    EXPECT_EQ(room.of(chunks).pages, pages_of(file.info().subtree_count));
  }
}

// A binary tree of so many levels, and large families of leaves below it.
LodTree bushy_tree(uint32_t levels) {
  std::vector<uint32_t> child_counts((1u << levels) - 1, 2);
  child_counts.insert(child_counts.end(), 1u << levels, kManyChildren + 20);
  child_counts.insert(child_counts.end(), (kManyChildren + 20) << levels, 0);
  LodTree tree = test::linked_tree(child_counts);
  tree.blend_share = kHalfShare;
  std::mt19937 random(3);
  test::set_boxes(tree, random);
  test::set_extents(tree, test::Extents::longest_side, random);
  return tree;
}

// Whichever chunks those are. Where none is large there is room for few.
TEST(RecordRoom, HasRoomForTheLargeFamiliesOfAnySoManyChunks) {
  std::vector<LodTree> trees;
  for (const TreeShape shape : {TreeShape::star, TreeShape::star_of_stars, TreeShape::four_way})
    trees.push_back(test::random_tree(shape, 20000, 3));
  for (const uint32_t levels : {5, 6, 7}) trees.push_back(bushy_tree(levels));
  uint32_t most = 0;  // of a chunk that lies in one tier
  for (const LodTree& tree : trees)
    for (const uint32_t chunk_bytes : {kMinChunkBytes, 2000 * uint32_t{sizeof(NodeRecord)}}) {
      SCOPED_TRACE(std::to_string(tree.size()) + ", " + std::to_string(chunk_bytes));
      const test::Bytes bytes =
          test::scene_bytes(test::baked_of(tree), Quality::compact, 0, chunk_bytes);
      const SceneFile file(test::source_of(bytes));
      const RecordRoom room(file);
      const auto chunks = static_cast<uint32_t>(file.chunks().size());
      std::vector<uint32_t> large;  // families of each chunk
      for (uint32_t chunk = 0; chunk < chunks; ++chunk) {
        const StagedChunk staged = stage_chunk(file.read_chunk(chunk), chunk, file.tiers(), "it");
        large.push_back(static_cast<uint32_t>(staged.large.size()));
        const bool last = chunk + 1 == chunks;
        const uint32_t bound = most_large_families(
            file.chunks()[chunk],
            last ? SubtreePlace::end_of(file.tiers()) : file.chunks().place(chunk + 1),
            file.tiers());
        EXPECT_GE(bound, large.back());
        if (bound < file.chunks()[chunk].node_count) most = std::max(most, large.back());
      }
      std::sort(large.begin(), large.end(), std::greater<>());
      uint32_t all = 0;
      for (uint32_t some = 1; some <= chunks; ++some) {
        all += large[some - 1];
        if (some < SceneStream::top_chunks(file)) continue;
        EXPECT_GE(room.of(some).families, all) << some;
      }
      if (all != 0 || chunk_bytes != kMinChunkBytes) continue;
      EXPECT_LT(room.of(chunks).families, file.info().node_count / kManyChildren / 2);
    }
  EXPECT_GT(most, 1u);
}

}  // namespace
}  // namespace voyager::record_room_test
