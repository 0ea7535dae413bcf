#include "runtime/format/plane_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_rules.h"

namespace voyager::plane_order_test {
namespace {

template <class Check>
void for_each_chunk(const BakedScene& baked, const Check& check) {
  const test::Bytes bytes = test::scene_bytes(baked, Quality::lossless, 0, kMinChunkBytes);
  const SceneFile file(test::source_of(bytes));
  for (uint32_t index = 0; index < file.chunks().size(); ++index) check(file.read_chunk(index));
}

// The node of each record, by its chunk's subtrees.
std::vector<uint32_t> nodes_of(const Chunk& chunk) {
  std::vector<uint32_t> nodes;
  for (const Subtree& subtree : chunk.subtrees)
    for (uint32_t slot = 0; slot < subtree.node_count(); ++slot)
      nodes.push_back(subtree.node(slot));
  return nodes;
}

// Of each record: the first of its subtree, and of what is below the roots there.
struct Start {
  uint32_t subtree, below;
};
std::vector<Start> starts_of(const Chunk& chunk) {
  std::vector<Start> starts;
  for (const Subtree& subtree : chunk.subtrees) {
    const auto first = static_cast<uint32_t>(starts.size());
    starts.insert(starts.end(), subtree.node_count(), {first, first + subtree.root_count});
  }
  return starts;
}

TEST(Families, AreThoseOfTheTree) {
  size_t whole = 0, split = 0;
  for (const test::TreeShape shape : test::kTreeShapes) {
    const BakedScene baked = test::baked_of(test::random_tree(shape, 3000, 6));
    for_each_chunk(baked, [&](const Chunk& chunk) {
      const Families families = families_of(counts_of(chunk));
      const std::vector<uint32_t> node = nodes_of(chunk);
      const std::vector<Start> start = starts_of(chunk);
      for (uint32_t i = 0; i < node.size(); ++i) {
        const Families::Run& run = families.children[i];
        for (uint32_t k = 0; k < run.count; ++k)
          ASSERT_EQ(node[run.first + k], baked.tree.first_child[node[i]] + k);
        const uint32_t all = chunk.records[i].child_count;
        uint32_t listed = 0;
        for (uint32_t k = 0; k < node.size(); ++k)
          listed += start[k].subtree == start[i].subtree && baked.tree.parent[node[k]] == node[i];
        ASSERT_EQ(run.count, listed == all ? all : 0);
        const uint32_t parent = families.parent[i];
        ASSERT_EQ(parent == kNoNode, i < start[i].below);
        ASSERT_TRUE(parent == kNoNode || node[parent] == baked.tree.parent[node[i]]);
        whole += run.count != 0, split += listed != 0 && listed != all;
      }
    });
  }
  EXPECT_GT(whole, 0u);
  EXPECT_GT(split, 0u);
}

// Of a damaged chunk, which is refused only once it is read.
TEST(Families, OfAnyCountsStayAmongTheRecords) {
  std::mt19937 random(3);
  for (int round = 0; round < 20000; ++round) {
    ChunkCounts counts;
    counts.of_subtree.resize(random() % 5);
    counts.of_record.resize(random() % 20);
    for (SubtreeCounts& subtree : counts.of_subtree)
      for (uint8_t* count : {&subtree.roots, &subtree.children, &subtree.grandchildren})
        *count = static_cast<uint8_t>(random() % (random() % 8 ? 4 : 256));
    for (uint32_t& count : counts.of_record) count = random() % (random() % 8 ? 4 : 0xffffffffu);
    const Families families = families_of(counts);
    for (uint32_t i = 0; i < counts.of_record.size(); ++i) {
      const Families::Run& run = families.children[i];
      ASSERT_TRUE(run.count == 0 ||
                  (run.first > i && run.first + run.count <= counts.of_record.size()));
      ASSERT_TRUE(families.parent[i] == kNoNode || families.parent[i] < i);
    }
  }
}

// What is restored in this order finds what tells it, and all that can be told is.
TEST(PlaneOrder, HoldsEachItemOnceAfterWhatTellsIt) {
  size_t boxes_told = 0, extents_told = 0, gaussians_told = 0;
  const auto check = [&](const Chunk& chunk) {
    const ChunkCounts counts = counts_of(chunk);
    const Families families = families_of(counts);
    const auto place_of = [](const PlaneOrder& order, size_t items) {
      std::vector<size_t> place(items, SIZE_MAX);
      EXPECT_EQ(order.item.size(), items);
      for (size_t at = 0; at < items; ++at) place[order.item[at]] = at;
      EXPECT_EQ(std::count(place.begin(), place.end(), SIZE_MAX), 0);
      return place;
    };
    const PlaneOrder boxes = box_order(families);
    const auto plain_boxes = boxes.item.begin() + static_cast<std::ptrdiff_t>(boxes.plain);
    ASSERT_TRUE(std::is_sorted(boxes.item.begin(), plain_boxes));
    ASSERT_TRUE(std::is_sorted(boxes.item.rbegin(), std::make_reverse_iterator(plain_boxes)));
    for (auto i = boxes.item.begin(); i != plain_boxes; ++i)
      ASSERT_EQ(families.children[*i].count, 0u);
    const std::vector<size_t> box = place_of(boxes, chunk.records.size());
    for (size_t at = boxes.plain; at < boxes.item.size(); ++at) {
      const Families::Run& run = families.children[boxes.item[at]];
      ASSERT_GT(run.count, 0u);
      for (uint32_t k = 0; k < run.count; ++k) ASSERT_LT(box[run.first + k], at);
    }
    const PlaneOrder extents = extent_order(families, counts);
    const std::vector<size_t> extent = place_of(extents, chunk.records.size());
    const auto plain_extents = extents.item.begin() + static_cast<std::ptrdiff_t>(extents.plain);
    ASSERT_TRUE(std::is_sorted(extents.item.begin(), plain_extents));
    ASSERT_TRUE(std::is_sorted(plain_extents, extents.item.end()));
    for (auto i = extents.item.begin(); i != plain_extents; ++i)
      ASSERT_TRUE(families.parent[*i] == kNoNode || counts.of_record[*i] > 1);
    for (size_t at = extents.plain; at < extents.item.size(); ++at)
      ASSERT_LT(extent[families.parent[extents.item[at]]], at);
    const GaussianOrder gaussians = gaussian_order(families, counts, chunk.record);
    const std::vector<size_t> gaussian = place_of(gaussians, chunk.record.size());
    for (size_t at = gaussians.plain; at < gaussians.item.size(); ++at) {
      const uint32_t child = gaussians.child[at - gaussians.plain];
      ASSERT_LT(gaussian[child], at);
      ASSERT_FALSE(chunk.is_leaf(child));
      ASSERT_EQ(chunk.node[child], chunk.first_child[gaussians.item[at]]);
    }
    boxes_told += boxes.item.size() - boxes.plain;
    extents_told += extents.item.size() - extents.plain;
    gaussians_told += gaussians.child.size();
  };
  for (const test::TreeShape shape : test::kTreeShapes)
    for_each_chunk(test::baked_of(test::random_tree(shape, 3000, 6)), check);
  for (const test::NamedRule& tree : test::all_rules())
    for_each_chunk(test::bake(test::random_cloud(3000, 4), tree.rule), check);
  EXPECT_GT(boxes_told, 0u);
  EXPECT_GT(extents_told, 0u);
  EXPECT_GT(gaussians_told, 0u);
}

}  // namespace
}  // namespace voyager::plane_order_test
