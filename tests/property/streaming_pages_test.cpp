// Tables that have no room for all subtrees of a file: what a pool and the views that read it have
// at a place is always the subtree's whose place it is, however late a view follows.
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "runtime/stream/record_bounds.h"
#include "runtime/stream/scene_stream.h"
#include "tests/support/scene_files.h"

namespace voyager::streaming_pages_test {
namespace {

const test::Bytes& scene() {
  static const test::Bytes bytes = [] {
    GaussianCloud cloud = test::random_cloud(20000, 6, 1);
    for (float& x : cloud.position) x *= 40;
    return test::scene_bytes(test::bake(cloud), Quality::compact, 0, kDefaultChunkBytes);
  }();
  return bytes;
}

// Tables of a device: what lies at a place is a subtree's, where something leads to it.
class PagedPool final : public ChunkPool {
 public:
  static constexpr uint32_t kNobody = 0xffffffffu;

  PagedPool(uint32_t subtrees, PoolRoom room) : pages_(pages_of(subtrees)) { resize(room); }

  void fill(std::span<const StagedChunk* const> chunks) override {
    for (const StagedChunk* chunk : chunks) bounds_.fill(*chunk);
  }
  const BoundsCode& bounds(const CheckedRecord& of) const override {
    return bounds_.at(of.slot, of.checked);
  }
  void resize(PoolRoom room) override {
    bounds_.make_room(room.slots);
    pages_.assign(pages_.size(), 0);
    at_.assign((room.pages + 1) * kPageSubtrees, kNobody);
    linked_.clear();
  }
  void apply(const LinkPatch& patch) override {
    for (const uint32_t subtree : patch.unlinked) {
      ASSERT_EQ(at_[place(subtree)], subtree);
      at_[place(subtree)] = kNobody;
      linked_.erase(subtree);
    }
    for (const PageChange& page : patch.pages) pages_[page.page] = page.place;
    for (const PageChange& page : patch.pages)
      for (uint32_t i = 0; page.place != 0 && i < kPageSubtrees; ++i)
        ASSERT_EQ(at_[page.place * kPageSubtrees + i], kNobody);
    moved_ += patch.pages.size();
    for (const auto& [subtree, linked] : patch.linked) {
      ASSERT_GE(place(subtree), kPageSubtrees) << "linked, and in the page of what has no place";
      ASSERT_LT(place(subtree), at_.size());
      ASSERT_EQ(at_[place(subtree)], kNobody);
      at_[place(subtree)] = subtree;
      linked_.insert(subtree);
    }
    std::set<uint32_t> pages;
    for (const uint32_t subtree : linked_) pages.insert(subtree / kPageSubtrees);
    most_ = std::max(most_, pages.size());
  }

  uint32_t place(uint32_t subtree) const { return SubtreePlaces{pages_.data()}(subtree); }
  const std::set<uint32_t>& linked() const { return linked_; }
  size_t places() const { return at_.size(); }
  size_t moved() const { return moved_; }
  // Pages with a subtree that was linked, at any time.
  uint32_t most() const { return static_cast<uint32_t>(most_); }

 private:
  RecordBounds bounds_;
  std::vector<uint32_t> pages_, at_;
  std::set<uint32_t> linked_;
  size_t moved_ = 0, most_ = 0;
};

// What a search has of its last cut, by place: the subtree that was open there.
class SearchState {
 public:
  SearchState(const SceneStream& stream, const PagedPool& pool)
      : stream_(stream), pool_(pool), open_(pool.places(), PagedPool::kNobody) {}

  void draw() {
    const bool known = stream_.changes_since(version_, changes_);
    version_ = stream_.version();
    if (!known) open_.assign(open_.size(), PagedPool::kNobody), forgot_ += drawn_;
    drawn_ = true;
    for (const auto& change : changes_)
      for (const uint32_t subtree : change->unlinked) {
        if (!known || pool_.linked().contains(subtree)) continue;
        uint32_t& open = open_[pool_.place(subtree)];
        ASSERT_TRUE(open == PagedPool::kNobody || open == subtree) << open << " " << subtree;
        open = PagedPool::kNobody;
      }
    for (size_t place = 0; place < open_.size(); ++place)
      if (open_[place] != PagedPool::kNobody) {
        ASSERT_EQ(pool_.place(open_[place]), place);
        ASSERT_TRUE(pool_.linked().contains(open_[place]));
      }
    for (const uint32_t subtree : pool_.linked()) open_[pool_.place(subtree)] = subtree;
  }
  size_t forgot() const { return forgot_; }

 private:
  const SceneStream& stream_;
  const PagedPool& pool_;
  std::vector<uint32_t> open_;
  std::vector<std::shared_ptr<const StreamChange>> changes_;
  uint64_t version_ = 0;
  size_t forgot_ = 0;
  bool drawn_ = false;
};

struct Flown {
  size_t moved = 0, forgot = 0;
  uint64_t evicted = 0;
  uint32_t most = 0, pages = 0;
};

// A viewer who jumps about, and three views of which the first draws after each commit. pages: room
// for them, where it is not what goes with the slots.
Flown fly(double share, uint32_t pages = 0) {
  const auto file = std::make_shared<const SceneFile>(test::source_of(scene()));
  const auto chunks = static_cast<double>(file->chunks().size());
  StreamDesc desc;
  desc.room = RecordRoom(*file).of(static_cast<uint32_t>(share * chunks));
  if (pages != 0) desc.room.pages = pages;
  desc.pinned = desc.first = SceneStream::top_chunks(*file);
  desc.readers = 0;
  desc.bytes.pool.page = 1;
  double time = 0;
  desc.clock = [&] { return time += 1e-4; };
  Workers workers(1);
  PagedPool pool(file->info().subtree_count, desc.room);
  SceneStream stream(file, desc, pool);
  stream.read_top(workers);
  SearchState views[] = {{stream, pool}, {stream, pool}, {stream, pool}};
  std::mt19937 random(7);
  const auto chance = [&](int of) { return random() % static_cast<unsigned>(of) == 0; };
  for (int frame = 0; frame < 600 && !testing::Test::HasFatalFailure(); ++frame) {
    if (chance(8)) {
      const float x = static_cast<float>(random() % 1000) - 500;
      stream.look(&pool, {Viewer{{{x, 0, 0}, 0.02f}, {}, false}});
    }
    for (int steps = 0; steps < 20 && stream.step(); ++steps) continue;
    stream.commit();
    views[0].draw();
    if (chance(10)) views[1].draw();
    if (chance(150)) views[2].draw();
  }
  EXPECT_TRUE(stream.take_messages().empty());
  return {pool.moved(), views[0].forgot(), stream.counters().chunks.evicted, pool.most(),
          pages_of(file->info().subtree_count)};
}

TEST(StreamingPages, WhatLiesAtAPlaceIsItsSubtreesHoweverLateAViewFollows) {
  for (const double share : {0.15, 0.3}) {
    SCOPED_TRACE(share);
    const Flown roomy = fly(share);
    if (testing::Test::HasFatalFailure()) return;
    EXPECT_EQ(roomy.forgot, 0u);
    const Flown tight = fly(share, roomy.most + 4);
    if (testing::Test::HasFatalFailure()) return;
    EXPECT_GT(tight.moved, 2 * roomy.most) << "no place was taken twice";
    EXPECT_GT(tight.forgot, 0u) << "every place could wait for all views";
    const Flown between = fly(share, roomy.most + roomy.most / 2);
    if (testing::Test::HasFatalFailure()) return;
    EXPECT_LT(between.forgot, tight.forgot);
  }
}

// Though chunks come and go, and their pages with them.
TEST(StreamingPages, WithRoomForAllNoneMoves) {
  const Flown flown = fly(0.9);
  EXPECT_GT(flown.evicted, 0u);
  EXPECT_LE(flown.moved, flown.pages);
  EXPECT_EQ(flown.forgot, 0u);
}

}  // namespace
}  // namespace voyager::streaming_pages_test
