// What rounding leaves of a tree: sound, and covered by rounded hulls.
#include "runtime/lod/round_bounds.h"

#include <gtest/gtest.h>

#include "runtime/lod/nesting.h"
#include "runtime/lod/subtrees.h"
#include "runtime/math/bounds_code.h"
#include "tests/support/random_trees.h"
#include "tests/support/rounded_tree.h"

namespace voyager::round_bounds_test {
namespace {

TEST(RoundBounds, ASoundTreeStaysSoundWhereverItLies) {
  for (const test::TreeShape shape : test::kTreeShapes)
    for (const Vec3f& at : {Vec3f{0, 0, 0}, Vec3f{256, 1024, -64}, Vec3f{-8192, 1e7f, 3}})
      for (const float scale : {1.0f, 0.01f}) {
        const LodTree tree = test::moved(test::random_tree(shape, 3000, 5), scale, at);
        const LodTree rounded = test::rounded(tree);
        for (uint32_t n = 0; n < tree.size(); ++n) {
          ASSERT_TRUE(is_inside(tree.records[n], rounded.records[n])) << n;
          if (n != 0) {
            ASSERT_TRUE(is_inside(rounded.records[n], rounded.records[tree.parent[n]])) << n;
          }
        }
        const LodTree again = test::rounded(rounded);
        for (uint32_t n = 0; n < tree.size(); ++n)
          ASSERT_TRUE(is_same(again.records[n], rounded.records[n])) << n;
      }
}

TEST(RoundBounds, ARoundedHullCoversWhatItsChunkHangsFrom) {
  for (const test::TreeShape shape : test::kTreeShapes) {
    const LodTree tree = test::moved(test::random_tree(shape, 3000, 5), 0.02f, {256, 1024, -64});
    const LodTree rounded = test::rounded(tree);
    const Partition partition = partition_tree(tree, kMinChunkBytes);
    for (size_t chunk = 0; chunk < partition.chunk_count(); ++chunk) {
      const EntryHull hull = round_bounds(partition.chunk_hull[chunk]);
      for (uint32_t s = partition.chunk_begin[chunk]; s < partition.chunk_begin[chunk + 1]; ++s) {
        const uint32_t parent = tree.parent[partition.subtrees[s].first_owned()];
        if (parent == kNoNode) continue;
        ASSERT_TRUE(
            is_inside(rounded.records[parent], {hull.box_min, hull.extent, hull.box_max, 0}));
      }
    }
  }
}

}  // namespace
}  // namespace voyager::round_bounds_test
