// Streaming from a disk that takes its time, and one that fails: flights, jumps, too little
// room, budgets that change, faults of every kind. Deterministic.
#include <atomic>
#include <map>
#include <random>
#include <thread>

#include "runtime/frame/whole_tree.h"
#include "runtime/math/screen_size.h"
#include "runtime/stream/record_bounds.h"
#include "tests/support/simulated_disk.h"
#include "tests/support/stream_rig.h"
#include "tests/support/tree_rules.h"

namespace voyager::streaming_disk_test {
namespace {

using test::expect_same_bits;
using test::Frame;
using test::frame_input;
using test::is_cut;
using test::look;
using test::render;
using test::SimulatedDisk;

constexpr double kFrame = 1.0 / 60;  // seconds

GaussianCloud wide_cloud(size_t count = 20000) {
  GaussianCloud cloud = test::random_cloud(count, 6, 1);
  for (float& x : cloud.position) x *= 40;
  return cloud;
}

// Baked once a rule for all tests.
const test::Bytes& wide_bytes(const TreeRule& rule) {
  static std::map<std::pair<TreeKind, uint32_t>, test::Bytes> made;
  test::Bytes& bytes = made[{rule.kind, rule.block}];
  if (bytes.empty())
    bytes = test::scene_bytes(test::bake(wide_cloud(), rule), Quality::lossless, 0, kMinChunkBytes);
  return bytes;
}

FrameInput ahead(const Vec3d& eye, const Vec3d& way, double tau = 3) {
  return frame_input(look(eye, eye + way, 61, 45, 60), tau);
}

// Holds nothing but bounds; fails while `fails`, or once.
class FailingPool final : public ChunkPool {
 public:
  explicit FailingPool(PoolRoom room) { bounds_.make_room(room.blocks); }

  void fill(std::span<const StagedChunk* const> chunks) override {
    if (late_once.exchange(false))
      throw Error(ErrorCode::timeout, "view: found a frame in flight that did not end");
    for (const StagedChunk* chunk : chunks) bounds_.fill(*chunk);
  }
  const BoundsCode& bounds(uint32_t record) const override { return bounds_[record]; }
  void apply(const LinkPatch&) override {
    if (fails || fails_once.exchange(false))
      throw Error(ErrorCode::device_lost, "pool: found no device");
  }
  void resize(PoolRoom room) override {
    if (refuses_once.exchange(false)) throw Error(ErrorCode::over_budget, "pool: found no memory");
    bounds_.make_room(room.blocks);
  }
  std::atomic<bool> fails{false}, fails_once{false}, late_once{false}, refuses_once{false};

 private:
  RecordBounds bounds_;
};

// A scene on a disk, and a view of it that draws a frame each 1/60 s.
class Flight {
 public:
  explicit Flight(double share, double latency = 0.002, double bandwidth = 20e6,
                  const TreeRule& rule = {})
      : rig_(wide_bytes(rule), share),
        disk_(std::make_shared<SimulatedDisk>(rig_.bytes, latency, bandwidth)),
        scene_(rig_.open(disk_, share)),
        view_(scene_, *rig_.backend, {}, rig_.memory(), rig_.workers,
              [this] { return rig_.time; }) {
    disk_->start(0);
  }

  // The frame, and what the disk does until the next one.
  Frame draw(const FrameInput& input) {
    Frame frame = render(view_, input);
    EXPECT_TRUE(is_cut(*whole_tree(*rig_.resident), frame.cut));
    EXPECT_LE(counters().resident, counters().slots);
    rig_.time += kFrame;
    disk_->idle_until(rig_.time - kFrame);
    while (disk_->is_free(rig_.time) && stream().step()) continue;
    return frame;
  }
  // Stands until nothing is missing, or for so many frames.
  Frame stand(const FrameInput& input, int frames = 600) {
    Frame frame = draw(input);
    for (int i = 0; i < frames && !(frame.stats.missing == 0 && i > 2); ++i) frame = draw(input);
    return frame;
  }
  Frame whole(const FrameInput& input) { return render(rig_.whole, input); }

  View& view() { return view_; }
  SceneStream& stream() const { return *scene_->stream; }
  StreamCounters counters() const { return stream().counters(); }
  SimulatedDisk& disk() { return *disk_; }
  Scene& scene() { return *scene_; }
  test::StreamRig& rig() { return rig_; }

 private:
  test::StreamRig rig_;
  std::shared_ptr<SimulatedDisk> disk_;
  std::shared_ptr<Scene> scene_;
  View view_;
};

const Vec3d kForward{0, 0.02, 1};

TEST(StreamingDisk, AFlightThatStopsEndsInTheResidentImage) {
  Flight flight(1.0);
  Vec3d eye{0, -3, -120};
  uint64_t coarse = 0;
  for (int i = 0; i < 240; ++i, eye.z += 0.5)
    coarse += flight.draw(ahead(eye, kForward)).stats.missing != 0;
  EXPECT_GT(coarse, 0u);
  const Frame end = flight.stand(ahead(eye, kForward));
  const Frame whole = flight.whole(ahead(eye, kForward));
  EXPECT_EQ(end.cut, whole.cut);
  expect_same_bits(end, whole);
}

// What lies ahead is asked for before it is needed.
TEST(StreamingDisk, AnEvenFlightFindsMostOfItsWayThere) {
  Flight flight(1.0, 0.001, 100e6);
  Vec3d eye{0, -3, -400};
  flight.stand(ahead(eye, kForward));
  const StreamCounters before = flight.counters();
  for (int i = 0; i < 300; ++i, eye.z += 0.3) flight.draw(ahead(eye, kForward));
  const StreamCounters after = flight.counters();
  const uint64_t arrived = after.chunks.arrived - before.chunks.arrived;
  ASSERT_GT(arrived, 20u);
  EXPECT_LT(after.chunks.late - before.chunks.late, arrived / 4);
}

// A quick one, of 100 degrees a second, in a pool without room for what is all around.
TEST(StreamingDisk, ATurnFindsMostOfWhatItShowsThere) {
  Flight flight(1.0, 0.001, 100e6);
  const auto turned = [](int frame) {
    const double angle = 0.029 * frame;
    return ahead({0, -3, 0}, {std::sin(angle), 0.02, std::cos(angle)}, 0.3);
  };
  flight.stand(turned(0));
  const ResidencyNeed need = flight.counters().need;
  const auto enough = static_cast<uint32_t>(need.seen + need.chunks + flight.stream().pinned()) / 2;
  flight.rig().give_room(flight.scene(), enough);
  flight.stand(turned(0), 60);
  const StreamCounters before = flight.counters();
  for (int i = 0; i < 200; ++i) flight.draw(turned(i));
  const StreamCounters after = flight.counters();
  const uint64_t arrived = after.chunks.arrived - before.chunks.arrived;
  ASSERT_GT(arrived, 20u);
  EXPECT_LT(after.chunks.late - before.chunks.late, arrived / 3);
}

// From a local disk, in a pool without room for what is all around.
TEST(StreamingDisk, AViewerWhoTurnsRoundSeesAllOfItInASecond) {
  Flight flight(1.0, 0.001, 100e6);
  const auto facing = [](double z) { return ahead({0, -3, 0}, {0, 0.02, z}, 0.3); };
  flight.stand(facing(1));
  const ResidencyNeed need = flight.counters().need;
  const auto enough = static_cast<uint32_t>(need.seen + need.chunks + flight.stream().pinned()) / 2;
  flight.rig().give_room(flight.scene(), enough);
  flight.stand(facing(1), 60);
  flight.draw(facing(-1));
  const StreamCounters before = flight.counters();
  EXPECT_GT(before.need.seen_missing, 20u);
  for (int i = 0; i < 60; ++i) flight.draw(facing(-1));
  EXPECT_EQ(flight.counters().need.seen_missing, 0u);
}

// In a pool with room for what is seen and 20 chunks more.
TEST(StreamingDisk, AWalkFindsWhatItShowsThere) {
  Flight flight(1.0, 0.001, 100e6);
  const auto at = [](int frame) { return ahead({0, -3, -150 + 0.15 * frame}, kForward, 0.3); };
  flight.stand(at(0));
  const ResidencyNeed need = flight.counters().need;
  const auto little = static_cast<uint32_t>(need.seen + 20 + flight.stream().pinned());
  flight.rig().give_room(flight.scene(), little);
  for (int i = -60; i < 12; ++i) flight.draw(at(std::max(i, 0)));  // until its way is known
  const StreamCounters before = flight.counters();
  for (int i = 12; i < 400; ++i) flight.draw(at(i));
  const StreamCounters after = flight.counters();
  const uint64_t arrived = after.chunks.arrived - before.chunks.arrived;
  ASSERT_GT(arrived, 20u);
  EXPECT_EQ(after.chunks.late, before.chunks.late);
}

class StreamingDiskOfTree : public ::testing::TestWithParam<test::NamedRule> {};
INSTANTIATE_TEST_SUITE_P(Rules, StreamingDiskOfTree, ::testing::ValuesIn(test::all_rules()),
                         test::rule_name<::testing::TestParamInfo<test::NamedRule>>);

// Room for half of what is seen, and a disk that takes longer to read it than the viewer stays.
TEST_P(StreamingDiskOfTree, AJumpTakesBackWhatIsNoLongerWanted) {
  Flight flight(1.0, 0.02, 1e6, GetParam().rule);
  const FrameInput here = ahead({0, -3, -150}, Vec3d{0, 0.02, -1}, 5),
                   there = ahead({0, -3, 150}, kForward, 5);
  flight.draw(here);
  while (flight.counters().need.seen == 0) ASSERT_TRUE(flight.stream().step());
  const uint64_t seen = flight.counters().need.seen + flight.stream().pinned();
  flight.rig().give_room(flight.scene(), static_cast<uint32_t>(seen / 2));
  for (int i = 0; i < 30; ++i) flight.draw(here);
  // Few, for families that were found to come together.
  const uint64_t before = flight.counters().chunks.flushed;
  ASSERT_LT(before, flight.counters().slots / 4);
  for (int i = 0; i < 30; ++i) flight.draw(there);
  EXPECT_GT(flight.counters().chunks.flushed, before);
}

TEST(StreamingDisk, ZigzagThrashesNothing) {
  Flight flight(0.3);
  for (int i = 0; i < 300; ++i) {
    const double x = i % 40 < 20 ? 40.0 : -40.0;
    flight.draw(ahead({x, -3, -60}, kForward));
  }
  // Both places fit or they do not; what one needs is not read again at every turn for ever.
  const StreamCounters counters = flight.counters();
  EXPECT_LT(counters.chunks.arrived, 15 * (counters.chunks.evicted + counters.slots));
}

// Less room than a frame needs: coarser, whole, and at rest.
TEST(StreamingDisk, ABudgetBelowTheWorkingSetIsCoarseAndAtRest) {
  Flight flight(0.03);
  const FrameInput input = ahead({0, -3, -60}, kForward, 0.3);
  Frame frame = flight.stand(input, 300);
  EXPECT_GT(frame.stats.missing, 0u);
  const uint64_t read = flight.counters().bytes_read;
  for (int i = 0; i < 60; ++i) EXPECT_EQ(flight.draw(input).cut, frame.cut);
  EXPECT_EQ(flight.counters().bytes_read, read);
}

TEST(StreamingDisk, ABudgetMayShrinkAndGrowInMidFlight) {
  Flight flight(0.6);
  test::StreamRig& rig = flight.rig();
  const RoomBytes bytes =
      rig.backend->room_bytes(flight.scene(), SceneStream::slot_shape(flight.stream().file()));
  const auto chunks = flight.stream().file().chunks().size();
  Vec3d eye{0, -3, -100};
  for (const double share : {0.05, 1.0, 0.02, 1.0}) {
    for (int i = 0; i < 30; ++i, eye.z += 0.5) flight.draw(ahead(eye, kForward));
    const auto slots = static_cast<uint32_t>(share * static_cast<double>(chunks));
    const PoolRoom room = RecordRoom(flight.stream().file()).of(slots);
    flight.scene().stream->set_budget(bytes.of(room), rig.workers);
    EXPECT_EQ(flight.draw(ahead(eye, kForward)).stats.missing > 0, true);
    ASSERT_EQ(flight.counters().slots, slots);
  }
  const Frame end = flight.stand(ahead(eye, kForward));
  expect_same_bits(end, flight.whole(ahead(eye, kForward)));
}

TEST(StreamingDisk, ABudgetWithoutRoomForTheTopIsRefusedAndChangesNothing) {
  Flight flight(0.6);
  const FrameInput input = ahead({0, -3, -60}, kForward);
  const Frame before = flight.stand(input);
  EXPECT_EQ(test::error_code([&] { flight.scene().stream->set_budget(100, flight.rig().workers); }),
            ErrorCode::over_budget);
  expect_same_bits(flight.draw(input), before);
}

// ------------------------------------------------------------------ faults

// Reads fail for a while: frames go on, the failure is told once, and all comes in the end.
TEST(StreamingDisk, ReadsThatFailAreTriedAgain) {
  Flight flight(1.0);
  const FrameInput input = ahead({0, -3, -60}, kForward);
  flight.disk().fault = [&](uint64_t offset, size_t) {
    throw Error(ErrorCode::io_transient,
                "disk.voy: offset " + std::to_string(offset) + ": found EIO");
  };
  for (int i = 0; i < 60; ++i) flight.draw(input);
  EXPECT_GT(flight.counters().failures, 1u);
  EXPECT_EQ(flight.stream().take_messages().size(), 1u);
  EXPECT_LT(flight.disk().reads, 300u) << "neither at once nor chunk by chunk";
  flight.disk().fault = nullptr;
  const Frame end = flight.stand(input, 2000);
  expect_same_bits(end, flight.whole(input));
  EXPECT_TRUE(flight.stream().take_messages().empty());
}

// A file that has become shorter since it was opened.
TEST(StreamingDisk, WhatWasCutOffIsStoodInFor) {
  Flight flight(1.0);
  const FrameInput input = ahead({0, -3, -60}, kForward);
  const uint64_t end = flight.disk().size() / 2;
  flight.disk().fault = [&](uint64_t offset, size_t size) {
    if (offset + size > end)
      throw Error(ErrorCode::io, "disk.voy: offset " + std::to_string(end) + ": found the end");
  };
  for (int i = 0; i < 200; ++i) flight.draw(input);
  const Frame frame = flight.draw(input);
  EXPECT_GT(frame.stats.missing, 0u);
  EXPECT_EQ(flight.stream().take_messages().size(), 1u);
}

// Every chunk but the top is altered: none of it is ever drawn.
TEST(StreamingDisk, DamagedChunksAreNeverDrawn) {
  Flight flight(1.0);
  const auto& chunks = flight.stream().file().chunks();
  const uint64_t top = chunks[flight.stream().pinned()].offset;
  flight.disk().alter = [&](uint64_t offset, std::span<std::byte> into) {
    for (size_t i = 0; i < into.size(); ++i)
      if (offset + i >= top && (offset + i) % 1000 == 0) into[i] ^= std::byte{1};
  };
  const FrameInput input = ahead({0, -3, -60}, kForward);
  const Frame before = flight.draw(input);
  for (int i = 0; i < 300; ++i) flight.draw(input);
  const Frame after = flight.draw(input);
  EXPECT_EQ(after.cut, before.cut);
  expect_same_bits(after, before);
  EXPECT_GT(flight.counters().failures, 1u);
}

// What cannot be read around the start does not keep a scene from opening.
TEST(StreamingDisk, ASceneOpensThoughWhatIsAroundItsStartIsDamaged) {
  Flight flight(1.0);
  const uint64_t top = flight.stream().file().chunks()[flight.stream().pinned()].offset;
  flight.disk().alter = [&](uint64_t offset, std::span<std::byte> into) {
    for (size_t i = 0; i < into.size(); ++i)
      if (offset + i >= top && (offset + i) % 1000 == 0) into[i] ^= std::byte{1};
  };
  const Vec3d eye{0, -3, -60};
  const auto disk = std::shared_ptr<const ByteSource>(std::shared_ptr<void>(), &flight.disk());
  const auto scene = flight.rig().open(disk, 1.0, 32 << 20, eye);
  EXPECT_EQ(scene->stream->counters().resident, scene->stream->pinned());
  EXPECT_GT(scene->stream->counters().failures, 1u);
  View view(scene, *flight.rig().backend, {}, flight.rig().memory(), flight.rig().workers);
  EXPECT_TRUE(is_cut(*whole_tree(*flight.rig().resident), render(view, ahead(eye, kForward)).cut));
}

// A source that takes long to give what is around the start: the scene opens after a second.
TEST(StreamingDisk, ASlowSourceDoesNotKeepASceneFromOpening) {
  Flight flight(1.0);
  double& time = flight.rig().time;
  const uint64_t top = flight.stream().file().chunks()[flight.stream().pinned()].offset;
  double first = -1;
  const auto slow = std::make_shared<SimulatedDisk>(flight.rig().bytes, 0.002, 20e6);
  slow->fault = [&](uint64_t offset, size_t) {
    if (offset < top) return;
    if (first < 0) first = time;
    time += 0.3;
  };
  const auto scene = flight.rig().open(slow, 1.0, 32 << 20, Vec3d{0, -3, -60});
  EXPECT_GE(time - first, 1.0);
  EXPECT_LE(time - first, 1.4);
  EXPECT_GT(scene->stream->counters().resident, scene->stream->pinned());
  EXPECT_LT(scene->stream->counters().resident, flight.stream().file().chunks().size());
}

// A frame that waits fails where a damaged chunk is seen, and does not where it is stood in for,
// or where nothing sees it.
TEST(StreamingDisk, AFrameThatWaitsSaysWhatIsDamaged) {
  Flight flight(1.0);
  const auto& chunks = flight.stream().file().chunks();
  // Nothing hangs from it, since that would not be there either, and it is of one place.
  const ChunkGraph graph(chunks, flight.stream().file().tiers());
  const auto reach = [&](uint32_t c) {
    const Vec3f side = chunks[c].hull.box_max - chunks[c].hull.box_min;
    return graph.children(c).empty() ? dot(side, side) : INFINITY;
  };
  uint32_t least = 0;
  for (uint32_t c = 1; c < graph.size(); ++c)
    if (reach(c) < reach(least)) least = c;
  const ChunkEntry& damaged = chunks[least];
  flight.disk().alter = [&](uint64_t offset, std::span<std::byte> into) {
    if (offset <= damaged.offset && offset + into.size() > damaged.offset)
      into[damaged.offset - offset] ^= std::byte{0x40};
  };
  FrameInput input = ahead({0, -3, -60}, kForward, 0.01);
  const Vec3d middle{0.5 * (double(damaged.hull.box_min.x) + double(damaged.hull.box_max.x)),
                     0.5 * (double(damaged.hull.box_min.y) + double(damaged.hull.box_max.y)),
                     0.5 * (double(damaged.hull.box_min.z) + double(damaged.hull.box_max.z))};
  input = frame_input(look(middle - Vec3d{0, 0, 30}, middle, 61, 45, 60), 0.01);
  input.wait_resident = true;
  EXPECT_EQ(test::error_code([&] { flight.draw(input); }), ErrorCode::damaged_chunk);
  input.stand_in = true;
  const Frame frame = flight.draw(input);
  EXPECT_GT(frame.stats.missing, 0u);
  // From behind, nothing of it is seen.
  FrameInput away =
      frame_input(look(middle + Vec3d{0, 0, 200}, middle + Vec3d{0, 0, 300}, 61, 45, 30), 1);
  away.wait_resident = true;
  const Frame sound = flight.draw(away);
  expect_same_bits(sound, flight.whole(away));
}

// A pool that could not take the links: what a frame would find is not what was linked.
TEST(StreamingDisk, APoolThatFailedIsNotDrawnFromUntilItIsFilledAnew) {
  const test::Bytes bytes = test::scene_bytes(test::bake(wide_cloud(2000)), Quality::compact);
  const auto file = std::make_shared<const SceneFile>(test::source_of(bytes));
  StreamDesc desc;
  const auto chunks = static_cast<uint32_t>(file->chunks().size());
  desc.room = RecordRoom(*file).of(chunks);
  desc.pinned = desc.first = SceneStream::top_chunks(*file);
  desc.readers = 0;
  double time = 0;
  desc.clock = [&] { return time; };
  Workers workers(1);
  FailingPool pool(desc.room);
  SceneStream stream(file, desc, pool);
  stream.read_top(workers);
  stream.look(&pool, {Viewer{{{0, 0, 0}, 1e-6f}, {}, false}});
  while (stream.step()) continue;
  const auto hold = [&] { stream.hold(); };
  const auto fail = [&] {
    pool.fails = true;
    while (stream.step()) continue;
    stream.commit();
    pool.fails = false;
    stream.commit();
    EXPECT_EQ(test::error_code(hold), ErrorCode::device_lost);
  };
  fail();
  stream.resize(desc.room, desc.pinned, workers);
  EXPECT_TRUE(stream.hold().owns_lock());
  // By itself, after a rest, and as often as that takes.
  fail();
  pool.fails = true;
  time += 10;
  while (stream.step()) time += 1e-3;
  EXPECT_EQ(test::error_code(hold), ErrorCode::device_lost);
  pool.fails = false;
  time += 10;
  while (stream.step()) time += 1e-3;
  EXPECT_TRUE(stream.hold().owns_lock());
  stream.commit();
  EXPECT_EQ(stream.counters().resident, chunks);
}

// A pool on threads of its own that fails once: nobody else need move for all to come again.
TEST(StreamingDisk, WhoeverStandsGetsWhatAFailureTook) {
  const test::Bytes bytes = test::scene_bytes(test::bake(wide_cloud(2000)), Quality::compact);
  const auto file = std::make_shared<const SceneFile>(test::source_of(bytes));
  StreamDesc desc;
  const auto chunks = static_cast<uint32_t>(file->chunks().size());
  desc.room = RecordRoom(*file).of(chunks);
  desc.pinned = desc.first = SceneStream::top_chunks(*file);
  Workers workers(1);
  FailingPool pool(desc.room);
  SceneStream stream(file, desc, pool);
  stream.read_top(workers);
  const std::vector<Viewer> viewers = {Viewer{{{0, 0, 0}, 1e-6f}, {}, false}};
  const auto stand = [&] {
    for (int i = 0; i < 500 && stream.counters().resident < chunks; ++i) {
      stream.look(&pool, viewers);
      stream.commit();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return stream.counters().resident;
  };
  pool.late_once = true;
  EXPECT_EQ(stand(), chunks) << "what a frame in flight kept from its slot never came";
  pool.fails_once = true;
  EXPECT_EQ(stand(), chunks);
  EXPECT_TRUE(stream.hold().owns_lock());
  pool.refuses_once = true;
  EXPECT_THROW(stream.resize(RecordRoom(*file).of(chunks - 1), desc.pinned, workers), Error);
  EXPECT_EQ(stand(), chunks);
}

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
TEST(StreamingDisk, ReadsOfAFarSourceLeaveAReaderForPlans) {
  const test::Bytes bytes =
      test::scene_bytes(test::bake(wide_cloud(2000)), Quality::compact, 0, kMinChunkBytes);
  const auto source = std::make_shared<FarSource>(bytes);
  const auto file = std::make_shared<const SceneFile>(source);
  StreamDesc desc;
  const auto chunks = static_cast<uint32_t>(file->chunks().size());
  desc.room = RecordRoom(*file).of(chunks);
  desc.pinned = desc.first = SceneStream::top_chunks(*file);
  desc.readers = 6;
  desc.read_bytes = 1024;
  Workers workers(1);
  FailingPool pool(desc.room);
  SceneStream stream(file, desc, pool);
  stream.read_top(workers);
  for (int i = 0; i < 500 && stream.counters().resident < chunks; ++i) {
    stream.look(&pool, {Viewer{{{0, 0, 0}, 1e-6f}, {}, false}});
    stream.commit();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(stream.counters().resident, chunks);
  EXPECT_GT(source->most(), 2u);
  EXPECT_LE(source->most(), desc.readers - 1);
}

// One thread links what many read. All that was read far ahead would be linked before what a viewer
// sees now.
TEST(StreamingDisk, ReadersStayNearWhatIsLinked) {
  constexpr uint64_t kFar = 512, kMostARead = 64;
  const auto file = std::make_shared<const SceneFile>(test::source_of(wide_bytes({})));
  StreamDesc desc;
  const auto chunks = static_cast<uint32_t>(file->chunks().size());
  ASSERT_GT(chunks, 2 * kFar);
  desc.room = RecordRoom(*file).of(chunks);
  desc.pinned = desc.first = SceneStream::top_chunks(*file);
  desc.readers = 4;
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
  for (int i = 0; i < 500 && stream.counters().resident < chunks; ++i) {
    stream.commit();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(stream.counters().resident, chunks);
}

// A source that stays away, slowly: frames that wait get to know, and chunks are not asked for one
// by one. When it comes back, all is well, and the next outage is told again.
TEST(StreamingDisk, AFrameThatWaitsForASourceThatStaysAwayFails) {
  Flight flight(1.0);
  uint64_t failed = 0;
  bool away = true;
  flight.disk().fault = [&](uint64_t, size_t) {
    if (!away) return;
    ++failed;
    flight.rig().time += 1;
    throw Error(ErrorCode::io_transient, "disk.voy: found no answer");
  };
  FrameInput input = ahead({0, -3, -60}, kForward);
  input.wait_resident = true;
  const auto draw = [&] { render(flight.view(), input); };
  EXPECT_EQ(test::error_code(draw), ErrorCode::io_transient);
  EXPECT_LE(failed, 10u);
  EXPECT_EQ(flight.stream().take_messages().size(), 1u);
  EXPECT_GT(flight.counters().need.seen_missing, 0u);
  // It opens, too, and draws what there is.
  away = false;
  auto opened = std::make_shared<SimulatedDisk>(flight.rig().bytes, 0.002, 20e6);
  opened->fault = [&](uint64_t offset, size_t) {
    const auto& chunks = flight.stream().file().chunks();
    if (offset <= chunks.front().offset || offset > chunks.back().offset) return;
    flight.rig().time += 1;
    throw Error(ErrorCode::io_transient, "disk.voy: found no answer");
  };
  const auto scene = flight.rig().open(opened, 1.0, 32 << 20, Vec3d{0, -3, -60});
  EXPECT_EQ(scene->stream->counters().resident, scene->stream->pinned());
  // The first is back.
  flight.rig().time += 60;
  expect_same_bits(render(flight.view(), input), flight.whole(input));
  EXPECT_EQ(flight.counters().need.seen_missing, 0u);
}

// Whoever looks away from an outage, and back when it is over, waits for what had failed.
TEST(StreamingDisk, AnOutageThatIsOverIsForgotten) {
  Flight flight(1.0);
  bool away = true;
  flight.disk().fault = [&](uint64_t, size_t) {
    if (away) throw Error(ErrorCode::io_transient, "disk.voy: found no answer");
  };
  FrameInput there = ahead({0, -3, -60}, kForward);
  there.wait_resident = true;
  for (int i = 0; i < 8; ++i, flight.rig().time += 11)
    EXPECT_EQ(test::error_code([&] { render(flight.view(), there); }), ErrorCode::io_transient);
  for (const double minutes : {0.0, 1.0, 10.0}) {
    away = false;
    for (int i = 0; i < 30; ++i) flight.draw(ahead({0, -3, 4000}, {0, 0, 1}, 60));
    flight.rig().time += 60 * minutes;
    expect_same_bits(render(flight.view(), there), flight.whole(there));
    EXPECT_EQ(flight.counters().need.seen_missing, 0u);
    away = true;
    flight.scene().stream->set_budget(0, flight.rig().workers);
    EXPECT_EQ(test::error_code([&] { render(flight.view(), there); }), ErrorCode::io_transient);
  }
}

// Chunks that cannot be had, of which nobody says that they might be: they are needed, and missing.
TEST(StreamingDisk, WhatHasFailedCountsAsMissing) {
  Flight flight(1.0);
  flight.disk().fault = [&](uint64_t, size_t) {
    throw Error(ErrorCode::file_not_found, "disk.voy: found nothing");
  };
  const uint64_t before = flight.disk().reads;
  const FrameInput input = ahead({0, -3, -60}, kForward);
  for (int i = 0; i < 50; ++i) flight.draw(input);
  EXPECT_GT(flight.counters().need.missing, 0u);
  EXPECT_GT(flight.counters().need.seen_missing, 0u);
  EXPECT_GT(flight.draw(input).stats.bytes_needed, 0u);
  EXPECT_LE(flight.disk().reads - before, 10u);  // a file that is gone is not asked for by chunks
}

// A node that lies outside of what it hangs from shows when its chunk is linked: a frame that waits
// fails, however late that is, and the chunk is read twice at most.
TEST_P(StreamingDiskOfTree, AChunkThatFitsNoParentIsDamaged) {
  BakedScene baked = test::bake(wide_cloud(4000), GetParam().rule);
  test::StreamRig sound(baked, 1.0);
  const SceneFile file(test::source_of(sound.bytes));
  const Vec3d eye{0, -2, -12};
  const double tau = 0.01;
  // The last of those whose parent no tree lets stand in.
  FrameInput input = frame_input(look(eye, {0, 0, 0}, 31, 25), tau);
  const Vec3f centre = cut_centre(eye, sound.resident->origin);
  const auto refined = [&](uint32_t n) {
    return baked.tree.screen_size(n, centre) >= 2 * target_size(tau, input.eyes[0].camera.fx);
  };
  uint32_t root = 0;
  for (uint32_t chunk = SceneStream::top_chunks(file); chunk < file.chunks().size(); ++chunk) {
    const Chunk content = file.read_chunk(chunk);
    for (const Subtree& subtree : content.subtrees)
      if (!subtree.repeats_root() && refined(baked.tree.parent[subtree.root])) root = subtree.root;
  }
  ASSERT_NE(root, 0u);
  baked.tree.records[root].box_max = {1e4f, 1e4f, 1e4f};
  const test::Bytes bytes = test::scene_bytes(baked, Quality::lossless, 0, kMinChunkBytes);
  const auto scene = sound.open(test::source_of(bytes), 1.0);
  View view(scene, *sound.backend, {}, sound.memory(), sound.workers);
  input.wait_resident = true;
  for (int i = 0; i < 3; ++i, sound.time += 20) {
    EXPECT_EQ(test::error_code([&] { render(view, input); }), ErrorCode::damaged_chunk);
    EXPECT_LE(scene->stream->counters().failures, 2u);
  }
  input.stand_in = true;
  EXPECT_GT(render(view, input).stats.missing, 0u);
}

// So does one whose roots hang from several nodes.
TEST_P(StreamingDiskOfTree, AChunkWithRootsOfSeveralNodesIsDamaged) {
  const BakedScene baked = test::bake(test::random_cloud(4000, 6, 0), GetParam().rule);
  test::StreamRig sound(baked, 1.0);
  Partition partition = partition_tree(baked.tree, kMinChunkBytes);
  ASSERT_TRUE(test::join_strangers(baked.tree, partition));
  const test::Bytes bytes = test::scene_bytes(baked, Quality::lossless, 0, partition);
  const auto scene = sound.open(test::source_of(bytes), 1.0);
  View view(scene, *sound.backend, {}, sound.memory(), sound.workers);
  FrameInput input = frame_input(look({0, -2, -30}, {0, 0, 0}, 600, 400), 0.0);
  input.wait_resident = true;
  try {
    render(view, input);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::damaged_chunk);
    EXPECT_NE(std::string(error.what()).find("hang from several nodes"), std::string::npos)
        << error.what();
  }
}

// The megabytes that a refusal names are enough.
TEST(StreamingDisk, ARefusedBudgetSaysWhatIsEnough) {
  Flight flight(0.1);
  FrameInput input = ahead({0, -3, -120}, kForward, 0.3);
  input.wait_resident = true;
  std::string message;
  try {
    render(flight.view(), input);
  } catch (const Error& error) {
    ASSERT_EQ(error.code(), ErrorCode::over_budget) << error.what();
    message = error.what();
  }
  const size_t takes = message.find("takes ");
  ASSERT_NE(takes, std::string::npos) << message;
  const double megabytes = std::stod(message.substr(takes + 6));
  flight.scene().stream->set_budget(static_cast<uint64_t>(megabytes * 1e6), flight.rig().workers);
  expect_same_bits(render(flight.view(), input), flight.whole(input));
}

TEST(StreamingDisk, OutOfMemoryIsAFailureLikeAnother) {
  Flight flight(1.0);
  int left = 5;
  flight.disk().fault = [&](uint64_t, size_t) {
    if (left-- > 0) throw std::bad_alloc();
  };
  const FrameInput input = ahead({0, -3, -60}, kForward);
  const Frame end = flight.stand(input, 2000);
  expect_same_bits(end, flight.whole(input));
}

}  // namespace
}  // namespace voyager::streaming_disk_test
