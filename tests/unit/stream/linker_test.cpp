// How large a cut of what is linked may be.
#include "runtime/stream/linker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "runtime/stream/record_bounds.h"
#include "runtime/stream/scene_stream.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"

namespace voyager::linker_test {
namespace {

// Knows the bounds of what it is filled with.
class BoundsPool final : public ChunkPool {
 public:
  explicit BoundsPool(uint32_t blocks) { bounds_.make_room(blocks); }
  void fill(std::span<const StagedChunk* const> chunks) override {
    for (const StagedChunk* chunk : chunks) bounds_.fill(*chunk);
  }
  const BoundsCode& bounds(uint32_t record) const override { return bounds_[record]; }
  void apply(const LinkPatch&) override {}
  void resize(PoolRoom) override {}

 private:
  RecordBounds bounds_;
};

// Every chunk has the slot of its own number. Its records are in blocks of its own, in any order.
class Linked {
 public:
  Linked(const SceneFile& file, uint64_t cut_nodes)
      : file_(file),
        shape_{kDefaultChunkBytes, kDefaultChunkBytes},
        graph_(file.chunks(), file.tiers()),
        next_block_(file.chunks().size() * shape_.records),
        linker_(graph_, shape_, next_block_),
        pool_(static_cast<uint32_t>(next_block_.size())) {
    linker_.make_room({graph_.size(), 0}, cut_nodes);
  }

  uint32_t chunks() const { return graph_.size(); }
  const ChunkGraph& graph() const { return graph_; }
  const Linker& linker() const { return linker_; }
  void arrive(uint32_t chunk) {
    LinkPatch patch;
    arrive(chunk, patch);
    finish(patch);
  }
  void arrive(uint32_t chunk, LinkPatch& patch) { linker_.arrive(stage(chunk), patch); }
  // In front of arrive(), or for nothing.
  void check(uint32_t chunk) { linker_.check(stage(chunk), pool_, file_.name()); }
  void evict(uint32_t chunk) {
    LinkPatch patch;
    evict(chunk, patch);
    finish(patch);
  }
  void evict(uint32_t chunk, LinkPatch& patch) { linker_.evict(chunk, patch); }
  void finish(LinkPatch& patch) {
    const size_t before = patch.linked.size();
    linker_.link_refused(patch);
    linked_again_ += patch.linked.size() - before;
    apply(patch);
  }
  // Subtrees that had no room at first.
  size_t linked_again() const { return linked_again_; }
  // As a pool does.
  void apply(const LinkPatch& patch) {
    for (const LinkPatch::Record& record : patch.cut.records) leading_.erase(record.record);
    for (const uint32_t subtree : patch.unlinked) linked_.erase(subtree);
    for (const LinkPatch::Record& record : patch.tied.records)
      EXPECT_TRUE(leading_.insert(record.record).second);
    for (const auto& [subtree, linked] : patch.linked) {
      EXPECT_TRUE(linked_.insert(subtree).second);
      EXPECT_TRUE(linked.entry == kNoRecord || leading_.count(linked.entry) != 0);
      EXPECT_EQ(linked.first_record, first_record_.at(subtree));
    }
  }
  const std::set<uint32_t>& linked() const { return linked_; }
  // How many nodes lead to subtrees.
  size_t leading() const { return leading_.size(); }
  bool may_arrive(uint32_t chunk) const {
    const ChunkGraph::Parents parents = graph_.parents(chunk);
    return !linker_.holds(chunk) && std::all_of(parents.begin(), parents.end(),
                                                [&](uint32_t p) { return linker_.holds(p); });
  }
  bool may_go(uint32_t chunk) const {
    const ChunkRange children = graph_.children(chunk);
    for (uint32_t child = children.first; child < children.last; ++child)
      if (linker_.holds(child)) return false;
    return linker_.holds(chunk);
  }

 private:
  StagedChunk stage(uint32_t chunk) {
    StagedChunk staged = stage_chunk(file_.read_chunk(chunk), chunk, file_.tiers(), file_.name());
    std::vector<uint32_t> blocks(staged.record_blocks());
    std::iota(blocks.begin(), blocks.end(), chunk * shape_.records);
    std::shuffle(blocks.begin(), blocks.end(), std::mt19937(chunk));
    for (size_t i = 1; i < blocks.size(); ++i) next_block_[blocks[i - 1]] = blocks[i];
    staged.put(chunk, std::move(blocks));
    const Tiers tiers = file_.tiers();
    for (LinkWalk at(staged.links, tiers, {staged.large, 0}); !at.at_end(); at.next())
      first_record_[at.subtree()] = at.interior() == 0 ? 0 : staged.record(at.first_record());
    const StagedChunk* const filled[] = {&staged};
    pool_.fill(filled);
    return staged;
  }

  const SceneFile& file_;
  SlotShape shape_;
  ChunkGraph graph_;
  std::vector<uint32_t> next_block_;
  Linker linker_;
  BoundsPool pool_;
  std::map<uint32_t, uint32_t> first_record_;  // by subtree
  std::set<uint32_t> linked_, leading_;        // subtrees; records
  size_t linked_again_ = 0;
};

// What a linker should have linked, found node by node.
class Expected {
 public:
  Expected(const SceneFile& file, const LodTree& tree) : tree_(tree), of_(tree.size()) {
    for (uint32_t chunk = 0; chunk < file.chunks().size(); ++chunk) {
      const Chunk content = file.read_chunk(chunk);
      size_t next = 0;
      for (const Subtree& s : content.subtrees) {
        const auto subtree = static_cast<uint32_t>(roots_.size());
        roots_.push_back(s.root);
        for (uint32_t k = s.first_owned_slot(); k < s.node_count(); ++k)
          of_[content.node[next++]] = {chunk, subtree};
      }
    }
  }

  // The most nodes that a cut may have.
  uint64_t largest_cut(const Linked& of) const {
    uint64_t nodes = 0;
    for (uint32_t n = 0; n < tree_.size(); ++n) nodes += is_linked(n, of) && !leads_on(n, of);
    return nodes;
  }
  // All is there that could be linked below a node, which is. Nodes beyond `room` are the reason.
  void check(const Linked& of, uint64_t room) const {
    const uint64_t cut = largest_cut(of);
    EXPECT_LE(cut, room);
    size_t leading = 0, refused = 0;
    for (uint32_t n = 0; n < tree_.size(); ++n) {
      if (!is_linked(n, of) || tree_.records[n].child_count == 0) continue;
      const uint32_t first = tree_.first_child[n], count = tree_.records[n].child_count;
      if (!is_root(first)) continue;
      leading += leads_on(n, of);
      const ChunkRange chunks = of.graph().with_family(of_[n].chunk, first, count);
      bool complete = true;
      for (uint32_t c = chunks.first; c < chunks.last; ++c) complete &= of.linker().holds(c);
      if (leads_on(n, of) || !complete) continue;
      ++refused;
      EXPECT_GT(cut - 1 + ends(first, count), room) << n;
    }
    EXPECT_EQ(of.leading(), leading);
    EXPECT_EQ(of.linker().lacks_room_for_cut(), refused != 0);
  }

 private:
  struct Owner {
    uint32_t chunk = 0, subtree = 0;
  };
  bool is_linked(uint32_t n, const Linked& of) const { return of.linked().count(of_[n].subtree); }
  bool leads_on(uint32_t n, const Linked& of) const {
    return tree_.records[n].child_count != 0 && is_linked(tree_.first_child[n], of);
  }
  bool is_root(uint32_t n) const { return roots_[of_[n].subtree] == n; }
  // Nodes of the subtrees with these roots of whose children they have none.
  uint64_t ends(uint32_t first, uint32_t count) const {
    uint64_t found = 0;
    for (uint32_t n = first; n < tree_.size(); ++n) {
      const uint32_t root = roots_[of_[n].subtree];
      if (root < first || root - first >= count) continue;
      found += tree_.records[n].child_count == 0 || is_root(tree_.first_child[n]);
    }
    return found;
  }

  const LodTree& tree_;
  std::vector<Owner> of_;  // by node
  std::vector<uint32_t> roots_;
};

// Of a whole tree: its leaves.
TEST(Linker, LeavesOutWhatCouldMakeACutTooLarge) {
  for (const test::TreeShape shape : test::kTreeShapes) {
    SCOPED_TRACE(test::name_of(shape));
    const LodTree tree = test::random_tree(shape, 2000, 4);
    const test::Bytes bytes =
        test::scene_bytes(test::baked_of(tree), Quality::compact, 0, kMinChunkBytes);
    const SceneFile file(test::source_of(bytes));
    const uint64_t leaves = file.info().leaf_count;
    const uint32_t top = SceneStream::top_chunks(file);
    Linked all(file, leaves), fewer(file, leaves - 1);
    for (uint32_t chunk = 0; chunk < top; ++chunk) all.arrive(chunk);
    // Also those that go and come again.
    for (int round = 0; round < 2; ++round) {
      for (uint32_t chunk = top; chunk < all.chunks(); ++chunk) all.arrive(chunk);
      EXPECT_EQ(all.linked().size(), file.info().subtree_count);
      EXPECT_FALSE(all.linker().lacks_room_for_cut());
      for (uint32_t chunk = all.chunks(); chunk-- > top;) all.evict(chunk);
    }
    if (top == all.chunks()) continue;
    for (uint32_t chunk = 0; chunk < fewer.chunks(); ++chunk) fewer.arrive(chunk);
    EXPECT_TRUE(fewer.linker().lacks_room_for_cut());
    EXPECT_LT(fewer.linked().size(), file.info().subtree_count);
  }
}

template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}
bool same(const LinkPatch& a, const LinkPatch& b) {
  return same(a.cut.records, b.cut.records) && a.cut.changed == b.cut.changed &&
         same(a.tied.records, b.tied.records) && a.tied.changed == b.tied.changed &&
         a.unlinked == b.unlinked && same(a.linked, b.linked) && same(a.outside, b.outside) &&
         a.left == b.left && same(a.arrived, b.arrived);
}

// What checking finds is what linking would find, and only for the chunk that was checked last.
TEST(Linker, LinksACheckedChunkAsItLinksOthers) {
  for (const test::TreeShape shape : test::kTreeShapes) {
    SCOPED_TRACE(test::name_of(shape));
    const LodTree tree = test::random_tree(shape, 1500, 4);
    const test::Bytes bytes =
        test::scene_bytes(test::baked_of(tree), Quality::compact, 0, kMinChunkBytes);
    const SceneFile file(test::source_of(bytes));
    const uint64_t room = file.info().leaf_count * 3 / 4;
    Linked plain(file, room), checked(file, room);
    const uint32_t top = SceneStream::top_chunks(file);
    std::mt19937 random(3);
    for (int step = 0; step < 60; ++step) {
      LinkPatch expected, found;
      if (step != 0)
        for (uint32_t chunk = plain.chunks(); chunk-- > top;) {
          if (random() % 3 != 0 || !plain.may_go(chunk)) continue;
          plain.evict(chunk, expected);
          checked.evict(chunk, found);
        }
      for (uint32_t chunk = 0; chunk < plain.chunks(); ++chunk) {
        if (chunk >= top && (random() % 3 == 0 || !plain.may_arrive(chunk))) continue;
        if (plain.linker().holds(chunk)) continue;
        plain.arrive(chunk, expected);
        if (random() % 4 != 0) checked.check(chunk);
        const uint32_t other = random() % plain.chunks();
        if (other > chunk && other >= top && checked.may_arrive(other)) checked.check(other);
        checked.arrive(chunk, found);
      }
      ASSERT_TRUE(same(expected, found)) << step;
      plain.finish(expected);
      checked.finish(found);
      ASSERT_TRUE(same(expected, found)) << step;
    }
  }
}

// Whatever comes and goes: what has no room is linked once it has, and forgotten once it is gone.
TEST(Linker, LinksWhatWasLeftOutOnceThereIsRoom) {
  size_t lacked = 0, lacked_no_more = 0, linked_again = 0;
  for (const test::TreeShape shape : test::kTreeShapes) {
    SCOPED_TRACE(test::name_of(shape));
    const LodTree tree = test::random_tree(shape, 2000, 4);
    const test::Bytes bytes =
        test::scene_bytes(test::baked_of(tree), Quality::compact, 0, kMinChunkBytes);
    const SceneFile file(test::source_of(bytes));
    const Expected expected(file, tree);
    const uint32_t top = SceneStream::top_chunks(file);
    Linked only_top(file, UINT64_MAX);
    for (uint32_t chunk = 0; chunk < top; ++chunk) only_top.arrive(chunk);
    const uint64_t room = (expected.largest_cut(only_top) + file.info().leaf_count) / 2;
    Linked some(file, room);
    for (uint32_t chunk = 0; chunk < top; ++chunk) some.arrive(chunk);
    std::mt19937 random(9);
    for (int step = 0; step < 200; ++step) {
      const bool lacks = some.linker().lacks_room_for_cut();
      LinkPatch patch;
      const auto chance = [&](uint32_t of_eight) { return random() % 8 < of_eight; };
      const uint32_t going = step % 40 < 20 ? 1 : 4;
      for (uint32_t chunk = some.chunks(); chunk-- > top;)
        if (chance(going) && some.may_go(chunk)) some.evict(chunk, patch);
      for (uint32_t chunk = top; chunk < some.chunks(); ++chunk)
        if (chance(5 - going) && some.may_arrive(chunk)) some.arrive(chunk, patch);
      some.finish(patch);
      expected.check(some, room);
      if (HasFailure()) return;
      lacked += some.linker().lacks_room_for_cut();
      lacked_no_more += lacks && !some.linker().lacks_room_for_cut();
    }
    for (uint32_t chunk = some.chunks(); chunk-- > top;)
      if (some.linker().holds(chunk)) some.evict(chunk);
    EXPECT_FALSE(some.linker().lacks_room_for_cut());
    linked_again += some.linked_again();
  }
  EXPECT_GT(lacked, 100u);
  EXPECT_GT(lacked_no_more, 10u);
  EXPECT_GT(linked_again, 10u);
}

}  // namespace
}  // namespace voyager::linker_test
