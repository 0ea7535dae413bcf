// What the threads do that read, and when they have nothing left to do.
#include <atomic>
#include <random>
#include <thread>

#include "tests/support/disk_flight.h"

namespace voyager::streaming_readers_test {
namespace {

using test::desc_of;
using test::FailingPool;
using test::wide_bytes;
using test::wide_cloud;

// Answers after some time, several reads at once.
class FarSource final : public ByteSource {
 public:
  explicit FarSource(const test::Bytes& bytes) : source_(test::source_of(bytes)) {}
  const std::string& name() const override { return source_->name(); }
  uint64_t size() const override { return source_->size(); }
  unsigned reads_at_once() const noexcept override { return 8; }
  void read(uint64_t offset, std::span<std::byte> into) const override {
    const unsigned now = ++in_flight_;
    for (unsigned most = most_; now > most && !most_.compare_exchange_weak(most, now);) continue;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    source_->read(offset, into);
    --in_flight_;
  }
  unsigned most() const { return most_; }

 private:
  std::shared_ptr<const ByteSource> source_;
  mutable std::atomic<unsigned> in_flight_{0}, most_{0};
};

// Where all readers waited for answers nobody would plan for who turns round.
TEST(StreamingReaders, ReadsOfAFarSourceLeaveAReaderForPlans) {
  const test::Bytes bytes =
      test::scene_bytes(test::bake(wide_cloud(2000)), Quality::compact, 0, kMinChunkBytes);
  const auto source = std::make_shared<FarSource>(bytes);
  const auto file = std::make_shared<const SceneFile>(source);
  StreamDesc desc = desc_of(*file, 6);
  desc.read_bytes = 1024;
  Workers workers(1);
  FailingPool pool(desc.room);
  SceneStream stream(file, desc, pool);
  stream.read_top(workers);
  for (int i = 0; i < 500 && stream.counters().resident < desc.room.slots; ++i) {
    stream.look(&pool, {Viewer{{{0, 0, 0}, 1e-6f}, {}, false}});
    stream.commit();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(stream.counters().resident, desc.room.slots);
  EXPECT_GT(source->most(), 2u);
  EXPECT_LE(source->most(), desc.readers - 1);
}

// One thread links what many read. All that was read far ahead would be linked before what a viewer
// sees now.
TEST(StreamingReaders, ReadersStayNearWhatIsLinked) {
  constexpr uint64_t kFar = 512, kMostARead = 64;
  const auto file = std::make_shared<const SceneFile>(test::source_of(wide_bytes({})));
  StreamDesc desc = desc_of(*file, 4);
  ASSERT_GT(desc.room.slots, 2 * kFar);
  desc.clock = [] { return 1.0; };  // a moment after the last frame
  Workers workers(1);
  FailingPool pool(desc.room);
  SceneStream stream(file, desc, pool);
  stream.read_top(workers);
  stream.commit();
  const auto read = [&] { return stream.counters().chunks.requested; };
  {
    const auto frame = stream.hold();  // nothing is linked meanwhile
    stream.look(&pool, {Viewer{{{0, 0, 0}, 1e-6f}, {}, false}});
    uint64_t before = 0;
    for (int i = 0; i < 200 && (before < kFar || read() != before); ++i) {
      before = read();
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
    }
    EXPECT_GE(read(), kFar);
    EXPECT_LE(read(), kFar + desc.readers * kMostARead);
  }
  for (int i = 0; i < 500 && stream.counters().resident < desc.room.slots; ++i) {
    stream.commit();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(stream.counters().resident, desc.room.slots);
}

// Plans leave out what is far from having room while a viewer moves. What comes to rest has had a
// plan of all, and has nothing more to do.
TEST(StreamingReaders, WhatIsAtRestHasPlannedForAll) {
  const auto file = std::make_shared<const SceneFile>(test::source_of(wide_bytes({})));
  StreamDesc desc = desc_of(*file, 0);
  desc.room = RecordRoom(*file).of(desc.room.slots / 4);
  Workers workers(1);
  FailingPool pool(desc.room), other_pool(desc.room);
  SceneStream stream(file, desc, pool);
  stream.read_top(workers);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> along(-200, 200);
  std::uniform_int_distribution<int> steps(0, 12);
  std::vector<Viewer> viewers;
  for (int jump = 0; jump < 120; ++jump) {
    // Every other time it turns back, so that what has been read is for nothing.
    const std::vector<Viewer> elsewhere{{{{along(random), 0, 0}, 0.04f}, {}, false}};
    if (jump % 2 == 0 || viewers.empty()) viewers = elsewhere;
    stream.look(&pool, elsewhere);
    for (int i = steps(random); i > 0; --i) stream.step();
    if (steps(random) < 4) stream.commit();
    stream.look(&pool, viewers);
    uint64_t version = 0;
    do {
      while (stream.step()) continue;
      ASSERT_FALSE(stream.step()) << jump;
      version = stream.version();
      stream.commit();
    } while (stream.version() != version || stream.step());
    if (jump % 8 != 0) continue;
    SceneStream other(file, desc, other_pool);
    other.read_top(workers);
    other.look(&other_pool, viewers);
    other.step();
    ASSERT_GT(other.counters().need.chunks, 2 * desc.room.slots);
    ASSERT_EQ(stream.counters().need.chunks, other.counters().need.chunks) << jump;
  }
}

}  // namespace
}  // namespace voyager::streaming_readers_test
