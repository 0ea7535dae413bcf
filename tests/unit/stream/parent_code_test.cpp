// What nodes of a pool hang from, as a device's pool keeps it: codes that a chunk brings, and one
// parent elsewhere for each subtree, which linking tells.
#include "runtime/math/parent_code.h"

#include <gtest/gtest.h>

#include <numeric>

#include "runtime/stream/linker.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"

namespace voyager::parent_code_test {
namespace {

// Every chunk has come, each to the slot of its own number.
struct Pool {
  Pool(const SceneFile& file, uint32_t slot_nodes)
      : nodes(slot_nodes),
        graph(file.chunks(), file.tiers()),
        next_block(file.chunks().size() * slot_nodes),
        linker(graph, {slot_nodes, slot_nodes}, next_block),
        address(file.info().node_count),
        codes(file.chunks().size() * slot_nodes),
        outside(file.info().subtree_count, kNoNode - 1) {
    std::iota(next_block.begin(), next_block.end(), 1);
    for (uint32_t chunk = 0; chunk < file.chunks().size(); ++chunk) {
      StagedChunk staged = stage_chunk(file.read_chunk(chunk), chunk, file.tiers(), file.name());
      for (size_t i = 0; i < staged.place.size(); ++i) {
        const uint32_t parent = staged.parent[i], at = chunk * nodes + staged.place[i];
        address[staged.content.node[i]] = at;
        codes[at] = (parent & StagedChunk::kOutside) == 0
                        ? parent
                        : outside_code(nodes, parent & ~StagedChunk::kOutside);
      }
      first_subtree.push_back(staged.links.first_subtree);
      std::vector<uint32_t> blocks(staged.record_blocks());
      std::iota(blocks.begin(), blocks.end(), chunk * nodes);
      staged.put(chunk, std::move(blocks));
      LinkPatch patch;
      linker.arrive(std::move(staged), patch);
      for (const LinkPatch::Outside& o : patch.outside) outside[o.subtree] = o.parent;
    }
  }

  // As its bytes hold them.
  template <class Code>
  void expect_parents(const LodTree& tree) const {
    const std::vector<Code> stored(codes.begin(), codes.end());
    for (size_t at = 0; at < codes.size(); ++at) ASSERT_EQ(stored[at], codes[at]);
    const PoolParents parents{
        stored.data(), first_subtree.data(), outside.data(), {nullptr}, nodes};
    for (uint32_t n = 0; n < tree.size(); ++n)
      ASSERT_EQ(parents(address[n]), n == 0 ? kNoNode : address[tree.parent[n]]) << n;
  }

  uint32_t nodes;
  ChunkGraph graph;
  std::vector<uint32_t> next_block;
  Linker linker;
  std::vector<uint32_t> address, codes, outside, first_subtree;
};

TEST(ParentCode, NamesTheParentOfEveryNode) {
  EXPECT_EQ(parent_code_bytes(128), 1u);
  EXPECT_EQ(parent_code_bytes(129), 2u);
  for (const test::TreeShape shape : test::kTreeShapes)
    for (const uint32_t slot_nodes : {32u, 128u, 129u, 2000u}) {
      SCOPED_TRACE(test::name_of(shape) + ", " + std::to_string(slot_nodes));
      const LodTree tree = test::random_tree(shape, 3000, 8);
      const test::Bytes bytes = test::scene_bytes(test::baked_of(tree), Quality::compact, 0,
                                                  slot_nodes * uint32_t{sizeof(NodeRecord)});
      const SceneFile file(test::source_of(bytes));
      const Pool pool(file, slot_nodes);
      if (parent_code_bytes(slot_nodes) == 1)
        pool.expect_parents<uint8_t>(tree);
      else
        pool.expect_parents<uint16_t>(tree);
    }
}

}  // namespace
}  // namespace voyager::parent_code_test
