// What nodes of a pool hang from, and the records that their weights depend on, as a device's pool
// finds them: by codes that a chunk brings, its subtrees, and one parent elsewhere for each of
// these, which linking tells.
#include "runtime/select/pool_nodes.h"

#include <gtest/gtest.h>

#include <numeric>

#include "runtime/stream/linker.h"
#include "tests/support/bounds_pool.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"

namespace voyager::pool_nodes_test {
namespace {

// Every chunk has come, each to the slot of its own number, and its records to every other block,
// or to neighbours.
struct Pool {
  Pool(const SceneFile& file, uint32_t slot_nodes, bool scattered)
      : nodes(slot_nodes),
        graph(file.chunks(), file.tiers()),
        next_block(2 * file.chunks().size() * slot_nodes),
        linker(graph, {slot_nodes, slot_nodes}, next_block),
        address(file.info().node_count),
        node_of_record(next_block.size() * kRecordBlock, kNoNode),
        owners(file.chunks().size() * slot_nodes),
        subtrees(file.info().subtree_count, kUnlinkedSubtree),
        outside(file.info().subtree_count, kNoNode - 1) {
    test::BoundsPool bounds(graph.size());
    Team alone(1);
    const uint32_t apart = scattered ? 2 : 1;
    for (uint32_t block = 0; block < next_block.size(); ++block) next_block[block] = block + apart;
    for (uint32_t chunk = 0; chunk < file.chunks().size(); ++chunk) {
      StagedChunk staged = stage_chunk(file.read_chunk(chunk), chunk, file.tiers(), file.name());
      for (size_t i = 0; i < staged.place.size(); ++i) {
        const uint32_t at = chunk * nodes + staged.place[i];
        address[staged.content.node[i]] = at;
        owners[at] = staged.owner[i];
      }
      first_subtree.push_back(staged.links.first_subtree);
      std::vector<uint32_t> blocks(staged.record_blocks());
      for (uint32_t i = 0; i < blocks.size(); ++i) blocks[i] = 2 * chunk * nodes + i * apart;
      staged.put(chunk, std::move(blocks));
      add_records(staged);
      const StagedChunk* const filled[] = {&staged};
      bounds.fill(filled);
      LinkPatch patch;
      Linker::Arrival arrival{&staged, chunk};
      std::vector<ChunkRange> divided;
      linker.arrive({&arrival, 1}, bounds, file.name(), alone, patch, divided);
      EXPECT_TRUE(arrival.held);
      for (const auto& [subtree, linked] : patch.linked) subtrees[subtree] = linked;
      for (const LinkPatch::Outside& o : patch.outside) outside[o.subtree] = o.parent;
    }
  }

  // Before linking, in the order of slots.
  void add_records(const StagedChunk& staged) {
    uint32_t slot_record = 0, number = 0;
    for (const Subtree& subtree : staged.content.subtrees) {
      for (uint32_t slot = 0; slot < subtree.node_count(); ++slot)
        if (staged.content.records[slot_record + slot].child_count != 0)
          node_of_record[staged.record(number++)] = subtree.node(slot);
      slot_record += subtree.node_count();
    }
  }

  // The codes as bytes hold them.
  template <class Code>
  void expect_all_found(const LodTree& tree) const {
    const std::vector<Code> stored(owners.begin(), owners.end());
    for (size_t at = 0; at < owners.size(); ++at) ASSERT_EQ(stored[at], owners[at]);
    const PoolNodes found{stored.data(), sizeof(Code), first_subtree.data(), nodes};
    const PoolParents parents{found, subtrees.data(), outside.data(), {nullptr}};
    for (uint32_t n = 0; n < tree.size(); ++n) {
      const uint32_t parent = n == 0 ? kNoNode : tree.parent[n];
      ASSERT_EQ(parents(address[n]), n == 0 ? kNoNode : address[parent]) << n;
      const SearchSubtree& s = subtrees[found.owner(address[n])];
      const CutOrigin origin = s.origin(s.slot_of(address[n]), next_block.data());
      const bool is_leaf = tree.records[n].child_count == 0;
      ASSERT_EQ(origin.own == kNoRecord, is_leaf) << n;
      if (!is_leaf) {
        ASSERT_EQ(node_of_record[origin.own], n);
      }
      ASSERT_EQ(origin.parent == kNoRecord, n == 0) << n;
      if (n != 0) {
        ASSERT_EQ(node_of_record[origin.parent], parent) << n;
      }
    }
  }

  uint32_t nodes;
  ChunkGraph graph;
  std::vector<uint32_t> next_block;
  Linker linker;
  std::vector<uint32_t> address, node_of_record, owners, first_subtree;
  std::vector<SearchSubtree> subtrees;
  std::vector<uint32_t> outside;
};

TEST(PoolNodes, NamesTheParentAndTheRecordsOfEveryNode) {
  EXPECT_EQ(owner_code_bytes(256), 1u);
  EXPECT_EQ(owner_code_bytes(257), 2u);
  for (const test::TreeShape shape : test::kTreeShapes)
    for (const uint32_t slot_nodes : {32u, 256u, 257u})
      for (const bool scattered : {false, true}) {
        SCOPED_TRACE(test::name_of(shape) + ", " + std::to_string(slot_nodes));
        const LodTree tree = test::random_tree(shape, 1000, 8);
        const test::Bytes bytes = test::scene_bytes(test::baked_of(tree), Quality::compact, 0,
                                                    slot_nodes * uint32_t{sizeof(NodeRecord)});
        const SceneFile file(test::source_of(bytes));
        const Pool pool(file, slot_nodes, scattered);
        if (owner_code_bytes(slot_nodes) == 1)
          pool.expect_all_found<uint8_t>(tree);
        else
          pool.expect_all_found<uint16_t>(tree);
      }
}

}  // namespace
}  // namespace voyager::pool_nodes_test
