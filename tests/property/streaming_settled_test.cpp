// What a viewer who stands still ends up with where a pool has too little room: a function of where
// it stands and of the room, whatever was seen before, and however slow the source.
#include <atomic>
#include <chrono>
#include <ostream>
#include <random>
#include <thread>

#include "runtime/frame/whole_tree.h"
#include "tests/support/random_trees.h"
#include "tests/support/stream_rig.h"

namespace voyager::streaming_settled_test {
namespace {

using test::Frame;
using test::frame_input;
using test::is_cut;
using test::look;
using test::render;
using test::StreamRig;

constexpr int kStands = 40;  // frames: so many, and a velocity is forgotten

const test::Bytes& scene() {
  static const test::Bytes bytes = test::scene_bytes(test::bake(test::random_cloud(8000, 12, 1)),
                                                     Quality::compact, 0, kMinChunkBytes);
  return bytes;
}

FrameInput from(const Vec3d& eye, double tau) {
  return frame_input(look(eye, {0, 0, 0}, 16, 12, 75), tau);
}

FrameInput somewhere(std::mt19937& random) {
  const double x = 40.0 * test::unit(random) - 20, z = 40.0 * test::unit(random) - 20;
  return from({x, -6, z}, 1 + random() % 2);
}

struct Room {
  const char* name;
  double slots, blocks;  // shares of what all chunks take
};
void PrintTo(const Room& room, std::ostream* out) {
  *out << room.name;
}

PoolRoom room_of(const SceneFile& file, const Room& share) {
  const RecordRoom records(file);
  const auto chunks = static_cast<double>(file.chunks().size());
  PoolRoom room = records.of(static_cast<uint32_t>(share.slots * chunks));
  const double all = records.of(static_cast<uint32_t>(chunks)).blocks;
  room.blocks = std::max(static_cast<uint32_t>(share.blocks * all),
                         (SceneStream::top_chunks(file) + 1) * records.most_blocks());
  return room;
}

Frame stand(const StreamRig& rig, View& view, const FrameInput& input) {
  Frame frame = render(view, input);
  for (int i = 0, idle = 0; idle < 2; ++i) {
    idle = rig.work() == 0 && i > kStands ? idle + 1 : 0;
    frame = render(view, input);
  }
  return frame;
}

class StreamingSettled : public testing::TestWithParam<Room> {
 protected:
  // A scene that is streamed with as little room.
  void limit(StreamRig& rig) const {
    const SceneFile& file = rig.stream().file();
    rig.stream().resize(room_of(file, GetParam()), SceneStream::top_chunks(file), rig.workers);
  }
};

// One sees all places, with much or little time at each, the other one none, the third does so
// after the next place but one.
TEST_P(StreamingSettled, DoesNotDependOnTheWay) {
  StreamRig one(scene(), 1.0), other(scene(), 1.0), fresh(scene(), 1.0);
  limit(one), limit(other);
  const auto tree = whole_tree(*one.resident);
  std::mt19937 random(2), wandering(3);
  size_t coarse = 0;
  for (int i = 0; i < 6; ++i) {
    const FrameInput input = somewhere(random);
    limit(fresh);
    for (uint32_t k = wandering() % 8; k > 0; --k) {
      render(other.part, somewhere(wandering));
      other.work(wandering() % 30);
    }
    const Frame frame = stand(one, one.part, input);
    ASSERT_TRUE(is_cut(*tree, frame.cut));
    ASSERT_EQ(stand(other, other.part, input).cut, frame.cut) << i;
    ASSERT_EQ(stand(fresh, fresh.part, input).cut, frame.cut) << i;
    coarse += frame.stats.missing != 0;
  }
  EXPECT_GT(coarse, 3u);
}

// All of that is settled: what went is not asked for again.
TEST_P(StreamingSettled, NothingMoves) {
  StreamRig rig(scene(), 1.0);
  limit(rig);
  std::mt19937 random(4);
  for (int i = 0; i < 6; ++i) {
    const FrameInput input = somewhere(random);
    const Frame frame = stand(rig, rig.part, input);
    const StreamCounters before = rig.stream().counters();
    for (int k = 0; k < 5; ++k) {
      ASSERT_EQ(render(rig.part, input).cut, frame.cut);
      ASSERT_EQ(rig.work(), 0u);
    }
    EXPECT_EQ(rig.stream().counters().reads, before.reads);
    EXPECT_EQ(rig.stream().counters().chunks.evicted, before.chunks.evicted);
  }
}

// Takes its time, another one at each read.
class SlowSource final : public ByteSource {
 public:
  explicit SlowSource(const test::Bytes& bytes) : source_(test::source_of(bytes)) {}
  const std::string& name() const override { return source_->name(); }
  uint64_t size() const override { return source_->size(); }
  void read(uint64_t offset, std::span<std::byte> into) const override {
    const uint32_t draw = reads_.fetch_add(1) * 2654435761u >> 16;
    std::this_thread::sleep_for(std::chrono::microseconds(draw % 7 == 0 ? 2000 : draw % 300));
    source_->read(offset, into);
  }

 private:
  std::shared_ptr<const ByteSource> source_;
  mutable std::atomic<uint32_t> reads_{0};
};

// Threads read, plan and decode as they come, while frames are drawn without end.
TEST_P(StreamingSettled, DoesNotDependOnThreads) {
  StreamRig rig(scene(), 1.0);
  limit(rig);
  StreamingDesc desc;
  desc.readers = 3;
  const auto threads = open_streamed(std::make_shared<SlowSource>(scene()), desc, *rig.backend,
                                     StreamRig::memory(), rig.workers);
  const SceneFile& file = rig.stream().file();
  threads->stream->resize(room_of(file, GetParam()), SceneStream::top_chunks(file), rig.workers);
  View view(threads, *rig.backend, {}, StreamRig::memory(), rig.workers);
  std::mt19937 random(5);
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 5; ++k) render(view, somewhere(random));
    const FrameInput input = somewhere(random);
    const Frame settled = stand(rig, rig.part, input);
    // At what a frame finds on the way nothing is held; what stays is that.
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    Frame frame = render(view, input);
    for (int same = 0; same < 20 && std::chrono::steady_clock::now() < until;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      frame = render(view, input);
      same = frame.cut == settled.cut ? same + 1 : 0;
    }
    ASSERT_EQ(frame.cut, settled.cut) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(WithFewer, StreamingSettled,
                         testing::Values(Room{"Slots", 0.3, 1.0}, Room{"Records", 1.0, 0.4},
                                         Room{"Both", 0.4, 0.3}),
                         [](const auto& room) { return std::string(room.param.name); });

}  // namespace
}  // namespace voyager::streaming_settled_test
