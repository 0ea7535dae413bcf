// What is hidden behind what is drawn is asked for last of what is seen; nothing but the order of
// reads depends on it.
#include <algorithm>
#include <random>

#include "tests/support/random_trees.h"
#include "tests/support/stream_rig.h"

namespace voyager::streaming_hidden_test {
namespace {

using test::expect_same_bits;
using test::Frame;
using test::frame_input;
using test::look;
using test::render;
using test::StreamRig;

constexpr float kBehind = 30;  // metres: all that is not the wall is farther along z

// A wall of opaque discs that fills the image, and as many specks, all in its shadow.
GaussianCloud wall_and_specks() {
  std::mt19937 random(1);
  const auto within = [&](float low, float high) {
    return low + (high - low) * test::unit(random);
  };
  GaussianCloud cloud = test::random_cloud(8000, 2, 3);
  for (size_t i = 0; i < cloud.size(); ++i) {
    const bool wall = i % 2 == 0;
    float* const position = &cloud.position[3 * i];
    const float reach = wall ? 8 : 20;
    position[0] = within(-reach, reach), position[1] = within(-reach, reach);
    position[2] = wall ? within(0, 0.1f) : within(kBehind, 2 * kBehind);
    for (size_t k = 0; k < 3; ++k) cloud.log_scale[3 * i + k] = std::log(wall ? 0.6f : 0.5f);
    for (size_t k = 0; k < 4; ++k) cloud.rotation[4 * i + k] = k == 0 ? 1.0f : 0.0f;
    if (wall) cloud.log_scale[3 * i + 2] = std::log(0.02f);
    cloud.opacity[i] = 6;
  }
  return cloud;
}

const test::Bytes& scene() {
  static const test::Bytes bytes =
      test::scene_bytes(test::bake(wall_and_specks()), Quality::lossless, 0, kMinChunkBytes);
  return bytes;
}

FrameInput before_the_wall() {
  return frame_input(look({0, 0, -9}, {0, 0, 0}, 96, 96, 60), 0.5);
}
FrameInput behind_the_wall() {
  return frame_input(look({0, 0, 20}, {0, 0, 0}, 96, 96, 60), 0.5);
}

// What is read, chunk by chunk.
class LoggedSource final : public ByteSource {
 public:
  const std::string& name() const override { return source_->name(); }
  uint64_t size() const override { return source_->size(); }
  void read(uint64_t offset, std::span<std::byte> into) const override {
    source_->read(offset, into);
    reads_.emplace_back(offset, offset + into.size());
  }
  std::vector<uint32_t> chunks_read(const ChunkDirectory& chunks) const {
    std::vector<uint32_t> read;
    for (const auto& [begin, end] : reads_)
      for (uint32_t chunk = 0; chunk < chunks.size(); ++chunk)
        if (chunks[chunk].offset >= begin && chunks[chunk].offset < end) read.push_back(chunk);
    return read;
  }

 private:
  std::shared_ptr<const ByteSource> source_ = test::source_of(scene());
  mutable std::vector<std::pair<uint64_t, uint64_t>> reads_;
};

// The scene, streamed with all the room that it wants, and one who looks.
struct Streamed {
  // told: what frames show counts. If not, there is somebody else who sees nothing, and tells it
  // to nobody.
  explicit Streamed(bool told, double share = 1.0)
      : rig(scene(), share),
        source(std::make_shared<LoggedSource>()),
        opened(rig.open(source, share)),
        view(opened, *rig.backend, {}, StreamRig::memory(), rig.workers) {
    Viewer nobody;
    nobody.query.target_size = INFINITY;
    if (!told) opened->stream->look(&nobody_name, {nobody});
  }
  Frame draw(const FrameInput& input) { return render(view, input); }
  // A few frames.
  void begin(const FrameInput& input) {
    for (int i = 0; i < 8; ++i) {
      draw(input);
      opened->stream->step();
    }
  }
  // A frame behind each `steps` steps, until nothing is left to do.
  Frame settle(const FrameInput& input, size_t steps = 2) {
    Frame frame = draw(input);
    for (int idle = 0; idle < 2;) {
      size_t done = 0;
      while (done < steps && opened->stream->step()) ++done;
      idle = done == 0 ? idle + 1 : 0;
      frame = draw(input);
    }
    return frame;
  }

  StreamRig rig;
  std::shared_ptr<LoggedSource> source;
  std::shared_ptr<Scene> opened;
  View view;
  char nobody_name = 0;
};

// Of a chunk of the wall and one behind it, how likely the latter is read later.
double read_later(const Streamed& of) {
  const ChunkDirectory& chunks = of.opened->stream->file().chunks();
  size_t of_wall = 0, behind = 0, later = 0;
  for (const uint32_t chunk : of.source->chunks_read(chunks)) {
    const EntryHull hull = chunks.hull(chunk);
    if (hull.box_max.z < kBehind / 2) ++of_wall;
    if (hull.box_min.z < kBehind / 2) continue;
    ++behind;
    later += of_wall;
  }
  return static_cast<double>(later) / static_cast<double>(of_wall * behind);
}

TEST(StreamingHidden, WhatIsBehindAWallIsAskedForLast) {
  Streamed with(true), without(false);
  const Frame frame = with.settle(before_the_wall());
  EXPECT_GT(read_later(with), 0.6);
  EXPECT_LT(read_later(without), 0.3);
  expect_same_bits(without.settle(before_the_wall()), frame);
  expect_same_bits(render(with.rig.whole, before_the_wall()), frame);
}

// From the other side, what was hidden is seen, and the other way round.
TEST(StreamingHidden, WhoeverHasMovedSeesAndWaitsForTheSame) {
  Streamed with(true, 0.4), without(false, 0.4);
  for (Streamed* one : {&with, &without}) one->begin(before_the_wall());
  const Frame frame = with.settle(behind_the_wall());
  EXPECT_GT(frame.stats.missing, 0u);
  EXPECT_EQ(without.settle(behind_the_wall()).cut, frame.cut);
  EXPECT_EQ(without.opened->stream->counters().resident, with.opened->stream->counters().resident);
  Streamed waits(true);
  waits.begin(before_the_wall());
  FrameInput input = behind_the_wall();
  input.wait_resident = true;
  expect_same_bits(waits.draw(input), render(waits.rig.whole, input));
}

// A plan for who stands before the wall, and what comes of it chunk by chunk.
class Planned {
 public:
  Planned() {
    Viewer viewer;
    viewer.query = {{10, 0, -9}, 0.02f};
    const Vec3f right{1, 0, 0};  // all of what it sees
    viewer.eyes = {{viewer.query.centre, {right, right, right, right, right}}};
    looks_.begin({viewer});
    residency_.plan(looks_);
  }
  // All that is asked for. shown(): from then on, before each read.
  template <class Told>
  std::vector<uint32_t> read_all(const Told& shown) {
    std::vector<uint32_t> order;
    for (;;) {
      residency_.set_shown(shown(residency_.slots()));
      const ChunkRange range = residency_.take_requests(1, 0);
      if (range.empty()) return order;
      order.push_back(range.first);
      residency_.read(range.first, records_.most_blocks(range.first));
      residency_.take_slot(range.first);
      residency_.filled(range.first);
      EXPECT_EQ(residency_.arrive([](uint32_t) { return true; }).resident.size(), 1u)
          << range.first << " came before what it hangs from";
    }
  }
  bool is_seen(uint32_t chunk) const { return residency_.is_seen(chunk); }

 private:
  const SceneFile file_{test::source_of(scene())};
  const Tiers tiers_ = file_.tiers();
  const ChunkGraph graph_{file_.chunks(), tiers_};
  const RecordRoom records_{file_};
  ChunkLooks looks_{file_.chunks()};
  Residency residency_{graph_, file_.chunks(), records_,
                       records_.of(static_cast<uint32_t>(2 * file_.chunks().size())), 1};
};

TEST(StreamingHidden, WhateverIsToldOnlyTheOrderOfReadsChanges) {
  Planned untold;
  std::vector<uint32_t> all = untold.read_all([](uint32_t) { return ShownChunks(); });
  // A frame that drew nothing hides nothing.
  EXPECT_EQ(Planned().read_all([](uint32_t slots) { return ShownChunks(slots); }), all);
  const auto first_unseen = std::ranges::find_if_not(
      all, [&](uint32_t chunk) { return chunk == 0 || untold.is_seen(chunk); });
  const auto seen = first_unseen - all.begin();
  EXPECT_GT(seen, 50);
  EXPECT_LT(seen + 50, static_cast<std::ptrdiff_t>(all.size()));
  std::ranges::sort(all);
  std::mt19937 random(7);
  for (int i = 0; i < 20; ++i) {
    Planned planned;
    std::vector<uint32_t> order = planned.read_all([&](uint32_t slots) {
      ShownChunks shown(random() % (slots + 1));
      for (Shown& of : shown) of = static_cast<Shown>(random() % 3);
      return shown;
    });
    const auto unseen = std::ranges::find_if_not(
        order, [&](uint32_t chunk) { return chunk == 0 || planned.is_seen(chunk); });
    EXPECT_EQ(unseen - order.begin(), seen);
    EXPECT_TRUE(
        std::none_of(unseen, order.end(), [&](uint32_t chunk) { return planned.is_seen(chunk); }));
    std::ranges::sort(order);
    EXPECT_EQ(order, all);
  }
}

}  // namespace
}  // namespace voyager::streaming_hidden_test
