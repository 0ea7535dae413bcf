// How large a cut of what is linked may be.
#include "runtime/stream/linker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <thread>
#include <utility>

#include "runtime/stream/scene_stream.h"
#include "tests/support/bounds_pool.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"

namespace voyager::linker_test {
namespace {

// Every chunk has the slot of its own number. Its records are in blocks of its own, in any order.
class Linked {
 public:
  Linked(const SceneFile& file, uint64_t cut_nodes)
      : file_(file),
        shape_{kDefaultChunkBytes, kDefaultChunkBytes},
        graph_(file.chunks(), file.tiers()),
        next_block_(file.chunks().size() * shape_.records),
        linker_(graph_, shape_, next_block_),
        pool_(graph_.size()) {
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
  void arrive(uint32_t chunk, LinkPatch& patch) {
    arrive(std::vector<uint32_t>{chunk}, alone_, patch);
  }
  // At once.
  void arrive(const std::vector<uint32_t>& chunks, Team& team, LinkPatch& patch) {
    std::vector<StagedChunk> staged;
    for (const uint32_t chunk : chunks) staged.push_back(stage(chunk));
    std::vector<Linker::Arrival> arrivals;
    for (StagedChunk& chunk : staged) arrivals.push_back({&chunk, chunk.chunk});
    std::vector<ChunkRange> divided;
    linker_.arrive(arrivals, pool_, file_.name(), team, patch, divided);
    for (const Linker::Arrival& arrival : arrivals) EXPECT_TRUE(arrival.held);
    divided_.insert(divided_.end(), divided.begin(), divided.end());
  }
  void evict(uint32_t chunk) {
    LinkPatch patch;
    evict(chunk, patch);
    finish(patch);
  }
  void evict(uint32_t chunk, LinkPatch& patch) {
    evict(std::vector<uint32_t>{chunk}, alone_, patch);
  }
  void evict(const std::vector<uint32_t>& chunks, Team& team, LinkPatch& patch) {
    linker_.evict(chunks, team, patch);
  }
  void finish(LinkPatch& patch) {
    const size_t before = patch.linked.size();
    linker_.link_refused(patch);
    linked_again_ += patch.linked.size() - before;
    apply(patch);
  }
  // Chunks that come at once, in this order, of which the first says something else of what it
  // repeats: which are held then.
  std::vector<bool> arrive_with_damage(const std::vector<uint32_t>& chunks) {
    std::vector<StagedChunk> staged;
    for (const uint32_t chunk : chunks) staged.push_back(stage(chunk));
    StagedChunk& damaged = staged.front();
    damaged.records[damaged.checked[damaged.links.nodes_below() + 2]].code.axis[0] ^= 1;
    const StagedChunk* const filled[] = {&damaged};
    pool_.fill(filled);
    std::vector<Linker::Arrival> arrivals;
    for (StagedChunk& chunk : staged) arrivals.push_back({&chunk, chunk.chunk});
    LinkPatch patch;
    std::vector<ChunkRange> divided;
    linker_.arrive(arrivals, pool_, file_.name(), alone_, patch, divided);
    std::vector<bool> held;
    for (const Linker::Arrival& arrival : arrivals) {
      EXPECT_NE(arrival.held, arrival.failure.has_value());
      held.push_back(arrival.held);
    }
    return held;
  }
  // Whether it begins with nodes of the chunk before.
  bool repeats(uint32_t chunk) {
    const StagedChunk staged = stage(chunk);
    return (staged.links.levels(0) >> 24 & 3) != 0;
  }
  // What the last batches have found, in an order of its own.
  std::vector<std::pair<uint32_t, uint32_t>> take_divided() {
    std::vector<std::pair<uint32_t, uint32_t>> all;
    for (const ChunkRange range : std::exchange(divided_, {}))
      all.emplace_back(range.first, range.last);
    std::sort(all.begin(), all.end());
    return all;
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
  test::BoundsPool pool_;
  Team alone_{1};
  std::vector<ChunkRange> divided_;
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

// Threads that help whoever links, until it is destroyed.
class Helpers {
 public:
  explicit Helpers(Team& team) {
    for (unsigned i = 1; i < team.lanes(); ++i)
      threads_.emplace_back([this, &team] {
        while (!ended_)
          if (!team.help()) std::this_thread::yield();
      });
  }
  ~Helpers() {
    ended_ = true;
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  std::atomic<bool> ended_{false};
  std::vector<std::thread> threads_;
};

// Of two neighbours that disagree about a node one stays out, in whatever order they come.
TEST(Linker, NeighboursThatDisagreeAreNotBothHeld) {
  size_t pairs = 0;
  for (const test::TreeShape shape : test::kTreeShapes) {
    SCOPED_TRACE(test::name_of(shape));
    const LodTree tree = test::random_tree(shape, 2000, 4);
    const test::Bytes bytes =
        test::scene_bytes(test::baked_of(tree), Quality::compact, 0, kMinChunkBytes);
    const SceneFile file(test::source_of(bytes));
    Linked linked(file, UINT64_MAX);
    for (uint32_t chunk = 0; chunk < linked.chunks(); ++chunk) {
      const bool both = chunk + 1 < linked.chunks() && linked.may_arrive(chunk) &&
                        linked.may_arrive(chunk + 1) && linked.repeats(chunk + 1);
      if (both) {
        EXPECT_EQ(linked.arrive_with_damage({chunk + 1, chunk}), (std::vector{false, true}));
        ++pairs;
      } else {
        linked.arrive(chunk);
      }
    }
  }
  EXPECT_GT(pairs, 20u);
}

// Batches that go and come, with parents and children in one, linked by four threads: the same is
// linked as by one, chunk by chunk, and each thing once.
TEST(Linker, ManyThreadsLinkWhatOneLinks) {
  for (const test::TreeShape shape : test::kTreeShapes) {
    SCOPED_TRACE(test::name_of(shape));
    const LodTree tree = test::random_tree(shape, 2000, 4);
    const test::Bytes bytes =
        test::scene_bytes(test::baked_of(tree), Quality::compact, 0, kMinChunkBytes);
    const SceneFile file(test::source_of(bytes));
    const Expected expected(file, tree);
    const uint32_t top = SceneStream::top_chunks(file);
    Linked one(file, UINT64_MAX), many(file, UINT64_MAX);
    Team team(4);
    const Helpers helpers(team);
    std::mt19937 random(5);
    for (int step = 0; step < 60; ++step) {
      LinkPatch by_one, by_many;
      std::vector<uint32_t> going, coming;
      for (uint32_t chunk = one.chunks(); step != 0 && chunk-- > top;) {
        if (random() % 3 != 0 || !one.may_go(chunk)) continue;
        one.evict(chunk, by_one);
        going.push_back(chunk);
      }
      for (uint32_t chunk = 0; chunk < one.chunks(); ++chunk) {
        if ((chunk >= top && random() % 3 == 0) || !one.may_arrive(chunk)) continue;
        one.arrive(chunk, by_one);
        coming.push_back(chunk);
      }
      {
        const Team::Session session(team);
        many.evict(going, team, by_many);
        many.arrive(coming, team, by_many);
      }
      one.finish(by_one);
      many.finish(by_many);
      ASSERT_EQ(many.linked(), one.linked()) << step;
      ASSERT_EQ(many.take_divided(), one.take_divided()) << step;
      expected.check(many, UINT64_MAX);
      if (HasFailure()) return;
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
    Team alone(1);
    for (int step = 0; step < 200; ++step) {
      const bool lacks = some.linker().lacks_room_for_cut();
      LinkPatch patch;
      const auto chance = [&](uint32_t of_eight) { return random() % 8 < of_eight; };
      const uint32_t going = step % 40 < 20 ? 1 : 4;
      std::vector<uint32_t> batch;  // in each second step what goes, goes at once
      for (uint32_t chunk = some.chunks(); chunk-- > top;) {
        if (!chance(going) || !some.may_go(chunk)) continue;
        if (step % 2 == 0)
          some.evict(chunk, patch);
        else
          batch.push_back(chunk);
      }
      some.evict(batch, alone, patch);
      batch.clear();
      for (uint32_t chunk = top; chunk < some.chunks(); ++chunk) {
        if (!chance(5 - going) || !some.may_arrive(chunk)) continue;
        if (step % 2 == 0)
          some.arrive(chunk, patch);
        else
          batch.push_back(chunk);
      }
      some.arrive(batch, alone, patch);
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
