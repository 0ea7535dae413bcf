#include "runtime/stream/chunk_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <set>

#include "runtime/stream/residency.h"
#include "runtime/stream/staged_chunk.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"
#include "tests/support/sealed.h"

namespace voyager::chunk_graph_test {
namespace {

// Of the smallest chunks that there are, so that many have nothing below them.
test::Bytes bytes_of(test::TreeShape shape, uint32_t nodes, uint32_t seed = 5) {
  return test::scene_bytes(test::baked_of(test::random_tree(shape, nodes, seed)), Quality::lossless,
                           0, kMinChunkBytes);
}

template <class Check>
void for_each_tree(const Check& check) {
  for (const test::TreeShape shape : test::kTreeShapes)
    for (const uint32_t nodes : {1u, 500u, 20000u}) {
      SCOPED_TRACE(test::name_of(shape) + " " + std::to_string(nodes));
      const test::Bytes bytes = bytes_of(shape, nodes);
      check(SceneFile(test::source_of(bytes)));
    }
}

using Leads = std::set<std::pair<uint32_t, uint32_t>>;  // from, to

// The chunk that owns the parent of a root: the last whose nodes' children begin no later.
uint32_t owner_by_directory(const SceneFile& file, uint32_t root) {
  uint32_t owner = 0;
  for (uint32_t chunk = 1; chunk < file.chunks().size(); ++chunk)
    if (file.chunks().place(chunk).next[3] <= root) owner = chunk;
  return owner;
}

Leads by_nodes(const SceneFile& file, const ChunkGraph& graph) {
  Leads leads;
  for (uint32_t chunk = 0; chunk < graph.size(); ++chunk)
    for (const Subtree& subtree : file.read_chunk(chunk).subtrees) {
      if (subtree.root == 0) continue;
      const uint32_t owner = owner_by_directory(file, subtree.root);
      EXPECT_EQ(graph.owner_of_parent(chunk, subtree.root), owner);
      if (owner != chunk) leads.emplace(owner, chunk);
    }
  return leads;
}

// As if the chunk went on with nothing of the one before.
test::Bytes without_repeats(test::Bytes bytes, uint32_t chunk) {
  FileHeader header;
  std::memcpy(&header, bytes.data(), sizeof header);
  const uint64_t at = header.directory.offset + chunk * sizeof(ChunkEntry);
  ChunkEntry entry;
  std::memcpy(&entry, bytes.data() + at, sizeof entry);
  entry.place.listed_children = entry.place.listed_grandchildren = 0;
  std::memcpy(bytes.data() + at, &entry, sizeof entry);
  return test::sealed(bytes);
}

// What links a chunk relies on it, and a directory that is opened may be wrong in this.
TEST(ChunkGraph, WhatARootHangsFromIsAParentAlsoIfTheDirectoryHidesARepeat) {
  size_t opened = 0;
  for (const test::TreeShape shape : test::kTreeShapes) {
    const test::Bytes sound = bytes_of(shape, 1000, 11);
    const uint32_t chunks = SceneFile(test::source_of(sound)).info().chunk_count;
    for (uint32_t edited = 1; edited < chunks; ++edited) {
      const test::Bytes bytes = without_repeats(sound, edited);
      std::optional<SceneFile> file;
      try {
        file.emplace(test::source_of(bytes));
      } catch (const Error&) {
        continue;
      }
      ++opened;
      const ChunkGraph graph(file->chunks(), file->tiers());
      for (uint32_t chunk = 0; chunk < chunks; ++chunk) {
        if (chunk == edited || chunk + 1 == edited) continue;  // damaged
        const ChunkGraph::Parents parents = graph.parents(chunk);
        for (const Subtree& subtree : file->read_chunk(chunk).subtrees) {
          if (subtree.root == 0) continue;
          const uint32_t owner = owner_by_directory(*file, subtree.root);
          EXPECT_EQ(graph.owner_of_parent(chunk, subtree.root), owner);
          EXPECT_TRUE(owner == chunk ||
                      std::find(parents.begin(), parents.end(), owner) != parents.end())
              << test::name_of(shape) << ": chunk " << chunk << ", edited " << edited;
        }
      }
    }
  }
  EXPECT_GT(opened, 10u);
}

// Who waits for its parents is looked at again by each of them, and none is of those that lead
// nowhere.
TEST(ChunkGraph, ParentsAndChildrenAreOneRelationWithAllThatNodesHangFrom) {
  for_each_tree([](const SceneFile& file) {
    const ChunkGraph graph(file.chunks(), file.tiers());
    Leads down, up;
    for (uint32_t chunk = 0; chunk < graph.size(); ++chunk) {
      const ChunkRange children = graph.children(chunk);
      for (uint32_t c = children.first; c < children.last; ++c) down.emplace(chunk, c);
      for (const uint32_t p : graph.parents(chunk)) up.emplace(p, chunk);
    }
    EXPECT_EQ(up, down);
    const Leads nodes = by_nodes(file, graph);
    EXPECT_TRUE(std::includes(up.begin(), up.end(), nodes.begin(), nodes.end()));
    // But for a chunk where a tier ends, which may lead to where the next one does.
    std::set<uint32_t> leading, idle;
    for (const auto& [from, to] : nodes) leading.insert(from);
    for (const auto& [from, to] : up)
      if (leading.count(from) == 0) idle.insert(from);
    EXPECT_LE(idle.size(), file.tiers().tier_begin.size());
  });
}

TEST(ChunkGraph, AFamilyIsWhereItsRootsAre) {
  for_each_tree([](const SceneFile& file) {
    const ChunkGraph graph(file.chunks(), file.tiers());
    const Tiers tiers = file.tiers();
    ChunkGraph::Families ascending(graph);
    for (uint32_t chunk = 0; chunk < graph.size(); ++chunk) {
      const StagedChunk staged = stage_chunk(file.read_chunk(chunk), chunk, tiers, file.name());
      ChunkGraph::Families own(graph, chunk);
      for (LinkWalk at(staged.links, tiers, {staged.large, 0}); !at.at_end(); at.next())
        at.each_below([&](const NodeBelow& node) {
          const ChunkRange found = graph.with_family(chunk, node.first_child, node.child_count);
          const ChunkRange expected = graph.with_roots(node.first_child, node.child_count);
          ASSERT_EQ(found.first, expected.first) << chunk;
          ASSERT_EQ(found.last, expected.last) << chunk;
          for (ChunkGraph::Families* families : {&ascending, &own}) {
            const ChunkRange again = families->of(chunk, node.first_child, node.child_count);
            ASSERT_EQ(again.first, expected.first) << chunk;
            ASSERT_EQ(again.last, expected.last) << chunk;
          }
        });
    }
  });
}

TEST(ChunkGraph, ChunksThatArriveInAnyOrderAllBecomeResident) {
  std::mt19937 random(3);
  for_each_tree([&](const SceneFile& file) {
    const ChunkGraph graph(file.chunks(), file.tiers());
    uint32_t top = 1;
    while (top < graph.size() && !graph.has_parents(top)) ++top;
    const RecordRoom records(file);
    Residency residency(graph, file.chunks(), records,
                        PoolRoom{graph.size(), graph.size() * records.most_blocks()}, top);
    ChunkLooks looks(file.chunks());
    looks.begin({Viewer{{{0, 0, 0}, 1e-30f}, {}, false}});
    residency.plan(looks, false);
    std::vector<uint32_t> come;
    for (;;) {
      const ChunkRange range = residency.take_requests(1, UINT64_MAX);
      if (range.empty()) break;
      come.push_back(range.first);
    }
    std::shuffle(come.begin(), come.end(), random);
    for (const uint32_t chunk : come) {
      ASSERT_TRUE(residency.read(chunk, records.most_blocks(chunk)));
      ASSERT_NE(residency.take_slot(chunk), Residency::kNoSlot);
      residency.filled(chunk);
      for (const uint32_t arrived : residency.begin_arrivals(SIZE_MAX).arriving)
        residency.end_arrival(arrived, Residency::Arrival::resident);
    }
    EXPECT_EQ(residency.resident(), come.size());
    EXPECT_EQ(residency.need().missing, 0u);
    // Where nobody looks they stay, unless cuts have no room for them: then all but the top goes.
    looks.begin({});
    residency.plan(looks, false);
    EXPECT_TRUE(residency.evict(SIZE_MAX).empty());
    residency.plan(looks, true);
    const std::vector<Residency::Evicted> gone = residency.evict(SIZE_MAX);
    EXPECT_EQ(gone.size(), come.size() - top);
    std::set<uint32_t> left;
    for (const Residency::Evicted& e : gone) {
      for (const uint32_t p : graph.parents(e.chunk)) EXPECT_EQ(left.count(p), 0u);
      left.insert(e.chunk);
      residency.free(e);
    }
  });
}

}  // namespace
}  // namespace voyager::chunk_graph_test
