// Streaming where reads fail, chunks are damaged, pools are lost and memory is refused.
#include <thread>

#include "runtime/math/screen_size.h"
#include "tests/support/disk_flight.h"

namespace voyager::streaming_faults_test {
namespace {

using test::ahead;
using test::desc_of;
using test::DiskFlight;
using test::expect_same_bits;
using test::FailingPool;
using test::Frame;
using test::frame_input;
using test::is_cut;
using test::look;
using test::render;
using test::SimulatedDisk;
using test::wide_cloud;

const Vec3d kForward{0, 0.02, 1};

class StreamingFaultsOfTree : public ::testing::TestWithParam<test::NamedRule> {};
INSTANTIATE_TEST_SUITE_P(Rules, StreamingFaultsOfTree, ::testing::ValuesIn(test::all_rules()),
                         test::rule_name<::testing::TestParamInfo<test::NamedRule>>);

// Reads fail for a while: frames go on, the failure is told once, and all comes in the end.
TEST(StreamingFaults, ReadsThatFailAreTriedAgain) {
  DiskFlight flight(1.0);
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

// Chunks are read one by one where they cannot be had at once, and another budget comes meanwhile:
// what was read for the pool before is nobody's. (Residency asserts that what was read was asked
// for.)
TEST(StreamingFaults, AnotherBudgetBetweenReadsOfOneChunkEach) {
  DiskFlight flight(0.5);
  const FrameInput input = ahead({0, -3, -60}, kForward);
  const auto& chunks = flight.stream().file().chunks();
  const auto is_one = [&](uint64_t offset, size_t size) {
    for (size_t i = 0; i < chunks.size(); ++i)
      if (chunks[i].offset == offset) return chunks[i].bytes == size;
    return false;
  };
  bool shorter = true;
  int changed = 0;
  flight.disk().fault = [&](uint64_t offset, size_t size) {
    if (!shorter) return;
    if (!is_one(offset, size)) throw Error(ErrorCode::io, "disk.voy: found the end");
    if (++changed == 2) flight.stream().set_budget(0, flight.rig().workers);
  };
  for (int i = 0; i < 40; ++i) flight.draw(input);
  EXPECT_GT(changed, 2);
  shorter = false;
  expect_same_bits(flight.stand(input, 2000), flight.whole(input));
  EXPECT_EQ(flight.counters().need.seen_missing, 0u);
}

// A file that has become shorter since it was opened.
TEST(StreamingFaults, WhatWasCutOffIsStoodInFor) {
  DiskFlight flight(1.0);
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
TEST(StreamingFaults, DamagedChunksAreNeverDrawn) {
  DiskFlight flight(1.0);
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
TEST(StreamingFaults, ASceneOpensThoughWhatIsAroundItsStartIsDamaged) {
  DiskFlight flight(1.0);
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
TEST(StreamingFaults, ASlowSourceDoesNotKeepASceneFromOpening) {
  DiskFlight flight(1.0);
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
TEST(StreamingFaults, AFrameThatWaitsSaysWhatIsDamaged) {
  DiskFlight flight(1.0);
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
TEST(StreamingFaults, APoolThatFailedIsNotDrawnFromUntilItIsFilledAnew) {
  const test::Bytes bytes = test::scene_bytes(test::bake(wide_cloud(2000)), Quality::compact);
  const auto file = std::make_shared<const SceneFile>(test::source_of(bytes));
  StreamDesc desc = desc_of(*file, 0);
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
  EXPECT_EQ(stream.counters().resident, desc.room.slots);
}

// A pool on threads of its own that fails once: nobody else need move for all to come again.
TEST(StreamingFaults, WhoeverStandsGetsWhatAFailureTook) {
  const test::Bytes bytes = test::scene_bytes(test::bake(wide_cloud(2000)), Quality::compact);
  const auto file = std::make_shared<const SceneFile>(test::source_of(bytes));
  const StreamDesc desc = desc_of(*file, 2);
  Workers workers(1);
  FailingPool pool(desc.room);
  SceneStream stream(file, desc, pool);
  stream.read_top(workers);
  const std::vector<Viewer> viewers = {Viewer{{{0, 0, 0}, 1e-6f}, {}, false}};
  const auto stand = [&] {
    for (int i = 0; i < 500 && stream.counters().resident < desc.room.slots; ++i) {
      stream.look(&pool, viewers);
      stream.commit();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return stream.counters().resident;
  };
  pool.late_once = true;
  EXPECT_EQ(stand(), desc.room.slots) << "what a frame in flight kept from its slot never came";
  pool.fails_once = true;
  EXPECT_EQ(stand(), desc.room.slots);
  EXPECT_TRUE(stream.hold().owns_lock());
  pool.refuses_once = true;
  EXPECT_THROW(stream.resize(RecordRoom(*file).of(desc.room.slots - 1), desc.pinned, workers),
               Error);
  EXPECT_EQ(stand(), desc.room.slots);
}

// A source that stays away, slowly: frames that wait get to know, and chunks are not asked for one
// by one. When it comes back, all is well, and the next outage is told again.
TEST(StreamingFaults, AFrameThatWaitsForASourceThatStaysAwayFails) {
  DiskFlight flight(1.0);
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
TEST(StreamingFaults, AnOutageThatIsOverIsForgotten) {
  DiskFlight flight(1.0);
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
TEST(StreamingFaults, WhatHasFailedCountsAsMissing) {
  DiskFlight flight(1.0);
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
TEST_P(StreamingFaultsOfTree, AChunkThatFitsNoParentIsDamaged) {
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
TEST_P(StreamingFaultsOfTree, AChunkWithRootsOfSeveralNodesIsDamaged) {
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

TEST(StreamingFaults, OutOfMemoryIsAFailureLikeAnother) {
  DiskFlight flight(1.0);
  int left = 5;
  flight.disk().fault = [&](uint64_t, size_t) {
    if (left-- > 0) throw std::bad_alloc();
  };
  const FrameInput input = ahead({0, -3, -60}, kForward);
  const Frame end = flight.stand(input, 2000);
  expect_same_bits(end, flight.whole(input));
}

}  // namespace
}  // namespace voyager::streaming_faults_test
