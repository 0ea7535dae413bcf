// Streaming from a disk that takes its time: flights, jumps, too little room, budgets that change.
// Deterministic.
#include "tests/support/disk_flight.h"

namespace voyager::streaming_disk_test {
namespace {

using test::ahead;
using test::DiskFlight;
using test::expect_same_bits;
using test::Frame;
using test::render;

const Vec3d kForward{0, 0.02, 1};

TEST(StreamingDisk, AFlightThatStopsEndsInTheResidentImage) {
  DiskFlight flight(1.0);
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
  DiskFlight flight(1.0, 0.001, 100e6);
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
  DiskFlight flight(1.0, 0.001, 100e6);
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
  DiskFlight flight(1.0, 0.001, 100e6);
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
  DiskFlight flight(1.0, 0.001, 100e6);
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
  DiskFlight flight(1.0, 0.02, 1e6, GetParam().rule);
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
  DiskFlight flight(0.3);
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
  DiskFlight flight(0.03);
  const FrameInput input = ahead({0, -3, -60}, kForward, 0.3);
  Frame frame = flight.stand(input, 300);
  EXPECT_GT(frame.stats.missing, 0u);
  const uint64_t read = flight.counters().bytes_read;
  for (int i = 0; i < 60; ++i) EXPECT_EQ(flight.draw(input).cut, frame.cut);
  EXPECT_EQ(flight.counters().bytes_read, read);
}

TEST(StreamingDisk, ABudgetMayShrinkAndGrowInMidFlight) {
  DiskFlight flight(0.6);
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
  DiskFlight flight(0.6);
  const FrameInput input = ahead({0, -3, -60}, kForward);
  const Frame before = flight.stand(input);
  EXPECT_EQ(test::error_code([&] { flight.scene().stream->set_budget(100, flight.rig().workers); }),
            ErrorCode::over_budget);
  expect_same_bits(flight.draw(input), before);
}

// The megabytes that a refusal names are enough.
TEST(StreamingDisk, ARefusedBudgetSaysWhatIsEnough) {
  DiskFlight flight(0.1);
  FrameInput input = ahead({0, -3, -120}, kForward, 0.3);
  input.wait_resident = true;
  std::string message;
  try {
    render(flight.view(), input);
  } catch (const Error& error) {
    ASSERT_EQ(error.code(), ErrorCode::over_budget) << error.what();
    message = error.what();
  }
  const size_t expected = message.find("expected ");
  ASSERT_NE(expected, std::string::npos) << message;
  const double megabytes = std::stod(message.substr(expected + 9));
  flight.scene().stream->set_budget(static_cast<uint64_t>(megabytes * 1e6), flight.rig().workers);
  expect_same_bits(render(flight.view(), input), flight.whole(input));
}

}  // namespace
}  // namespace voyager::streaming_disk_test
