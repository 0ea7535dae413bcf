// What a link table tells of a chunk, against the chunk itself.
#include "runtime/stream/link_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "runtime/select/search_records.h"
#include "runtime/stream/chunk_pool.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"

namespace voyager::link_table_test {
namespace {

template <class Check>
void for_each_chunk(const Check& check) {
  for (const test::TreeShape shape : test::kTreeShapes)
    for (const uint32_t chunk_bytes : {kMinChunkBytes, kDefaultChunkBytes, 1u << 16}) {
      SCOPED_TRACE(test::name_of(shape) + " " + std::to_string(chunk_bytes));
      const LodTree tree = test::random_tree(shape, 3000, 12);
      const test::Bytes bytes =
          test::scene_bytes(test::baked_of(tree), Quality::compact, 0, chunk_bytes);
      const SceneFile file(test::source_of(bytes));
      for (uint32_t chunk = 0; chunk < file.chunks().size(); ++chunk) {
        const Chunk content = file.read_chunk(chunk);
        check(file, content, stage_chunk(Chunk(content), chunk, file.tiers(), file.name()));
        if (testing::Test::HasFatalFailure()) return;
      }
    }
}

// Of each node that a chunk owns.
std::vector<uint32_t> places_by_record(const Chunk& content, const StagedChunk& staged) {
  std::vector<uint32_t> places(content.records.size(), kNoNode);
  for (size_t i = 0; i < content.node.size(); ++i) places[content.record[i]] = staged.place[i];
  return places;
}

TEST(LinkTable, TellsWhatTheChunkHolds) {
  size_t below_found = 0;
  for_each_chunk([&](const SceneFile& file, const Chunk& content, const StagedChunk& staged) {
    const Tiers tiers = file.tiers();
    const std::vector<uint32_t> places = places_by_record(content, staged);
    LinkWalk at(staged.links, tiers, {staged.large, 0});
    RootWalk roots(staged.links, tiers);
    uint32_t first = 0, records = 0, below = 0;
    for (const Subtree& s : content.subtrees) {
      ASSERT_FALSE(at.at_end());
      const auto record = [&](uint32_t slot) -> auto& {
        return content.records[first + slot];
      };
      ASSERT_EQ(at.subtree(), content.first_subtree + (&s - content.subtrees.data()));
      ASSERT_EQ(at.levels(), slot_levels(s));
      ASSERT_EQ(at.interior(), interior_slots(s, record));
      ASSERT_EQ(at.families(), family_slots(s, record));
      ASSERT_EQ(at.root(), s.root);
      ASSERT_EQ(roots.root(), s.root);
      ASSERT_EQ(at.root_count(), s.root_count);
      ASSERT_EQ(at.child_count(), s.child_count);
      ASSERT_EQ(at.repeats_root(), s.repeats_root());
      ASSERT_EQ(at.repeats_child(), s.repeats_child());
      ASSERT_EQ(at.first_record(), records);
      for (uint32_t level = 0; level < 3; ++level)
        for (uint32_t slot = s.first_slot(level), k = 0; slot < s.first_slot(level + 1); ++slot) {
          if (s.repeats(slot)) continue;
          ASSERT_EQ(at.place(level) + k++, places[first + slot]);
        }
      at.each_below([&](const NodeBelow& node) {
        ASSERT_EQ(node.index, below++);
        const auto i = static_cast<size_t>(
            std::find(staged.place.begin(), staged.place.end(), node.place) - staged.place.begin());
        ASSERT_LT(i, staged.place.size());
        ASSERT_EQ(node.first_child, content.first_child[i]);
        ASSERT_EQ(node.child_count, content.record_of(i).child_count);
        ASSERT_EQ(staged.records[node.record].children, kBlocked);
      });
      first += s.node_count();
      records += static_cast<uint32_t>(std::popcount(at.interior()));
      at.next();
      roots.next();
    }
    ASSERT_TRUE(at.at_end());
    ASSERT_TRUE(roots.at_end());
    ASSERT_EQ(below, staged.links.nodes_below());
    below_found += below;
    const auto shape = static_cast<uint32_t>(content.records.size());
    ASSERT_LE(staged.links.bytes(), LinkTable::chunk_bytes(shape) +
                                        content.subtrees.size() * LinkTable::kSubtreeBytes +
                                        below * LinkTable::kBelowBytes);
  });
  EXPECT_GT(below_found, 1000u);
}

// Flags are among what else is there.
TEST(LinkTable, FlagsChangeNothingElse) {
  std::mt19937 random(3);
  for_each_chunk([&](const SceneFile& file, const Chunk&, StagedChunk staged) {
    const auto told = [&] {
      const Tiers tiers = file.tiers();
      std::vector<uint32_t> all;
      for (LinkWalk at(staged.links, tiers, {staged.large, 0}); !at.at_end(); at.next()) {
        all.insert(all.end(), {at.levels(), at.interior(), at.families(), at.root()});
        at.each_below([&](const NodeBelow& node) {
          all.insert(all.end(), {node.place, node.record, node.first_child, node.child_count});
        });
      }
      return all;
    };
    const std::vector<uint32_t> before = told();
    LinkTable& table = staged.links;
    std::vector<bool> to(table.subtrees()), on(table.nodes_below());
    for (int i = 0; i < 200; ++i) {
      const auto subtree = static_cast<uint32_t>(random() % to.size());
      table.set_leads_to(subtree, to[subtree] = random() % 2 != 0);
      if (on.empty()) continue;
      const auto below = static_cast<uint32_t>(random() % on.size());
      const bool leads = random() % 2 != 0;
      EXPECT_EQ(leads ? table.begin_to_lead_on(below) : table.end_to_lead_on(below),
                on[below] != leads);
      on[below] = leads;
    }
    for (uint32_t i = 0; i < to.size(); ++i) ASSERT_EQ(table.leads_to(i), to[i]);
    for (uint32_t i = 0; i < on.size(); ++i) ASSERT_EQ(table.leads_on(i), on[i]);
    ASSERT_EQ(told(), before);
  });
}

}  // namespace
}  // namespace voyager::link_table_test
