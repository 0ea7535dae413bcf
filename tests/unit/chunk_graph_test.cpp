#include "runtime/stream/chunk_graph.h"

#include <gtest/gtest.h>

#include "runtime/stream/residency.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"

namespace voyager {
namespace {

// Of the smallest chunks that there are, so that many have nothing below them.
SceneFile file_of(test::TreeShape shape, uint32_t nodes) {
  const test::Bytes bytes = test::scene_bytes(test::baked_of(test::random_tree(shape, nodes, 5)),
                                              Quality::lossless, 0, kMinChunkBytes);
  return SceneFile(test::source_of(bytes));
}

template <class Check>
void for_each_tree(const Check& check) {
  for (const test::TreeShape shape : test::kTreeShapes)
    for (const uint32_t nodes : {1u, 500u, 20000u}) {
      SCOPED_TRACE(test::name_of(shape) + " " + std::to_string(nodes));
      check(file_of(shape, nodes));
    }
}

// Who waits for its parents is looked at again by each of them.
TEST(ChunkGraph, ParentsAndChildrenAreOneRelation) {
  for_each_tree([](const SceneFile& file) {
    const ChunkGraph graph(file.chunks(), file.tiers());
    const auto among = [](ChunkRange range, uint32_t chunk) {
      return range.first <= chunk && chunk < range.last;
    };
    for (uint32_t chunk = 0; chunk < graph.size(); ++chunk) {
      const ChunkRange parents = graph.parents(chunk), children = graph.children(chunk);
      for (uint32_t p = parents.first; p < parents.last; ++p)
        ASSERT_TRUE(among(graph.children(p), chunk)) << p << " leads to " << chunk;
      for (uint32_t c = children.first; c < children.last; ++c)
        ASSERT_TRUE(among(graph.parents(c), chunk)) << c << " hangs from " << chunk;
    }
  });
}

TEST(ChunkGraph, ChunksThatArriveInAnyOrderAllBecomeResident) {
  std::mt19937 random(3);
  for_each_tree([&](const SceneFile& file) {
    const ChunkGraph graph(file.chunks(), file.tiers());
    uint32_t top = 1;
    while (top < graph.size() && graph.parents(top).empty()) ++top;
    Residency residency(graph, file.chunks(), graph.size(), top);
    const Viewer everything{{{0, 0, 0}, 1e-30f}, {}, false};
    residency.plan({&everything, 1});
    std::vector<uint32_t> come;
    for (;;) {
      const ChunkRange range = residency.take_requests(1, UINT64_MAX);
      if (range.empty()) break;
      come.push_back(range.first);
    }
    std::shuffle(come.begin(), come.end(), random);
    for (const uint32_t chunk : come) {
      ASSERT_TRUE(residency.read(chunk));
      ASSERT_NE(residency.take_slot(chunk), Residency::kNoSlot);
      residency.filled(chunk);
      residency.arrive([](uint32_t) { return true; });
    }
    EXPECT_EQ(residency.resident(), come.size());
    EXPECT_EQ(residency.need().missing, 0u);
  });
}

}  // namespace
}  // namespace voyager
