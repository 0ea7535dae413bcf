// A scene of which only a part is there is drawn as its resident part allows, and once all
// that is needed has come, as if it were there whole.
#include <chrono>
#include <map>
#include <random>
#include <thread>
#include <utility>

#include "runtime/frame/whole_tree.h"
#include "tests/support/random_trees.h"
#include "tests/support/stream_rig.h"
#include "tests/support/tree_clouds.h"
#include "tests/support/tree_rules.h"

namespace voyager::streaming_test {
namespace {

using test::expect_same_bits;
using test::Frame;
using test::frame_input;
using test::is_cut;
using test::look;
using test::render;
using test::StreamRig;

std::vector<FrameInput> walk(size_t frames, uint32_t seed, double tau) {
  std::mt19937 random(seed);
  Vec3d eye{0, -2, -30}, way{0, 0, 1};
  std::vector<FrameInput> inputs;
  for (size_t i = 0; i < frames; ++i) {
    if (i % 17 == 16) eye = {60.0 * test::unit(random) - 30, -5, 60.0 * test::unit(random) - 30};
    if (i % 5 == 0)
      way = {2.0 * test::unit(random) - 1, test::unit(random) - 0.5, 2.0 * test::unit(random) - 1};
    eye = eye + way;
    inputs.push_back(frame_input(look(eye, eye + way + Vec3d{0.01, 0.02, 0.03}, 61, 45, 75), tau));
  }
  return inputs;
}

// Baked once for all tests.
const test::Bytes& random_scene(size_t count, uint32_t seed) {
  static std::map<std::pair<size_t, uint32_t>, test::Bytes> made;
  test::Bytes& bytes = made[{count, seed}];
  if (bytes.empty())
    bytes = test::scene_bytes(test::bake(test::random_cloud(count, seed, 1)), Quality::lossless, 0,
                              kMinChunkBytes);
  return bytes;
}

PipelineDesc searching(Search search) {
  PipelineDesc desc;
  desc.search = search;
  return desc;
}

TEST(Streaming, FramesThatWaitEqualResidentOnes) {
  for (const Search search : {Search::temporal, Search::temporal_visit, Search::streaming}) {
    StreamRig rig(random_scene(4000, 3), 1.0, searching(search));
    for (FrameInput input : walk(40, 1, 6)) {
      const Frame whole = render(rig.whole, input);
      input.wait_resident = true;
      const Frame part = render(rig.part, input);
      ASSERT_EQ(part.cut, whole.cut);
      expect_same_bits(part, whole);
      ASSERT_EQ(part.stats.missing, 0u);
    }
  }
}

// Trees of every shape, with nodes of more children than a subtree holds.
TEST(Streaming, TreesOfAnyShapeStream) {
  for (const test::TreeShape shape : test::kTreeShapes) {
    std::mt19937 random(7);
    for (const uint32_t nodes : {1u, 40u, 1000u}) {
      SCOPED_TRACE(test::name_of(shape) + " " + std::to_string(nodes));
      StreamRig rig(test::baked_of(test::random_tree(shape, nodes, 5)), 1.0);
      std::vector<Vec3f> places = test::random_places(*whole_tree(*rig.resident), random);
      std::shuffle(places.begin(), places.end(), random);
      places.resize(std::min<size_t>(places.size(), 30));
      for (const Vec3f& place : places) {
        const Vec3d eye{place.x, place.y, place.z};
        for (const double tau : {0.5, 8.0}) {
          FrameInput input = frame_input(look(eye, eye + Vec3d{0, 0.1, 1}, 16, 16), tau);
          const Frame before = render(rig.part, input);
          ASSERT_TRUE(is_cut(*whole_tree(*rig.resident), before.cut));
          const Frame whole = render(rig.whole, input);
          input.wait_resident = true;
          const Frame part = render(rig.part, input);
          ASSERT_EQ(part.cut, whole.cut);
          expect_same_bits(part, whole);
        }
      }
    }
  }
}

// A little is read between any two frames, and there is room for a part only.
// However much has come: no frame waits for all of it.
TEST(Streaming, AFrameLinksFewOfManyChunksAndLaterOnesTheRest) {
  StreamRig rig(random_scene(4000, 3), 1.0);
  const FrameInput input = frame_input(look({0, -2, -30}, {0, 0, 0}, 61, 45, 75), 0.1);
  render(rig.part, input);
  rig.work();  // all that is needed has a slot
  const auto resident = [&] { return rig.stream().counters().resident; };
  uint32_t before = resident(), frames = 0;
  for (;; ++frames) {
    EXPECT_TRUE(is_cut(*whole_tree(*rig.resident), render(rig.part, input).cut));
    if (resident() == before) break;
    EXPECT_LE(resident() - before, 64u);
    before = resident();
  }
  EXPECT_GT(frames, 2u);
  EXPECT_EQ(rig.stream().counters().need.missing, 0u);
}

TEST(Streaming, EveryFrameDrawsACut) {
  for (const double share : {0.02, 0.1, 0.3, 1.0})
    for (const size_t steps : {0u, 1u, 3u, 20u}) {
      SCOPED_TRACE(std::to_string(share) + ", steps " + std::to_string(steps));
      StreamRig rig(random_scene(4000, 3), share);
      for (const FrameInput& input : walk(60, 2, 4)) {
        const Frame frame = render(rig.part, input);
        ASSERT_TRUE(is_cut(*whole_tree(*rig.resident), frame.cut));
        ASSERT_LE(rig.stream().counters().resident, rig.stream().counters().slots);
        rig.work(steps);
      }
    }
}

TEST(Streaming, AStandingViewerConvergesToTheResidentFrameAndThenNothingMoves) {
  StreamRig rig(random_scene(4000, 3), 1.0);
  const std::vector<FrameInput> inputs = walk(30, 3, 5);
  for (size_t i = 0; i < inputs.size(); ++i) {
    render(rig.part, inputs[i]);
    rig.work(2);
    if (i % 10 != 9) continue;
    const Frame part = rig.settle(inputs[i]), whole = render(rig.whole, inputs[i]);
    ASSERT_EQ(part.cut, whole.cut);
    expect_same_bits(part, whole);
    const StreamCounters before = rig.stream().counters();
    const Frame again = render(rig.part, inputs[i]);
    EXPECT_EQ(rig.work(), 0u);
    EXPECT_EQ(rig.stream().counters().bytes_read, before.bytes_read);
    EXPECT_EQ(again.stats.entered + again.stats.left, 0u);
    EXPECT_EQ(again.stats.bytes_streamed, 0u);
  }
}

// A clustered tree's extents are errors, far below the boxes or far above.
TEST(Streaming, WhatReachesIntoAFrameIsOfTheBoxWhateverTheExtent) {
  const Vec3f right{1, 0, 0};
  const Viewer viewer{
      {{0, 0, 0}, 1e-3f}, {{{0, 0, 0}, {right, right, right, right, right}}}, false};
  for (const float extent : {1e-3f, 1.0f, 1e3f}) {
    EXPECT_TRUE(viewer.sees({{-3, 0, 0}, extent, {-1.5f, 2, 1}})) << extent;
    EXPECT_FALSE(viewer.sees({{-4, 0, 0}, extent, {-2.5f, 2, 1}})) << extent;
  }
}

// METHOD §12: Gaussians far smaller than their footprint are drawn metres beyond their boxes.
TEST(Streaming, WhatReachesIntoAFrameHasItsFootprint) {
  GaussianCloud cloud = test::random_cloud(4000, 6, 0);
  for (float& scale : cloud.log_scale) scale = std::log(0.01f);
  for (size_t i = 0; i < cloud.size(); ++i) {
    cloud.position[3 * i] *= 2;
    cloud.position[3 * i + 1] *= 0.05f;
    cloud.position[3 * i + 2] *= 0.05f;
  }
  cloud.native = {NativeSource::given, 5, kPixelVariance};
  StreamRig rig(test::bake(cloud, test::kHierarchicalGs), 1.0);
  const auto chunks = static_cast<uint32_t>(rig.stream().file().chunks().size());
  for (const double x : {-10.0, 0.0, 10.0}) {
    // The Gaussians are 4 m below the picture.
    FrameInput input = frame_input(look({x, -7, -30}, {x, -7, 0}, 96, 64, 13.7), 0);
    rig.give_room(chunks);
    const Frame whole = render(rig.whole, input);
    ASSERT_GT(whole.at(48, 63)[3], 0.5f);
    input.wait_resident = true;
    expect_same_bits(render(rig.part, input), whole);
    rig.give_room(static_cast<uint32_t>(rig.stream().counters().need.seen) + rig.stream().pinned());
    expect_same_bits(render(rig.part, input), whole);
  }
}

class StreamingOfTree : public ::testing::TestWithParam<test::NamedRule> {
 protected:
  BakedScene bake(const GaussianCloud& cloud) const { return test::bake(cloud, GetParam().rule); }
};
INSTANTIATE_TEST_SUITE_P(Rules, StreamingOfTree, ::testing::ValuesIn(test::all_rules()),
                         test::rule_name<::testing::TestParamInfo<test::NamedRule>>);

// Where there is room for what is seen, what is around may be coarse: no pixel shows it.
TEST_P(StreamingOfTree, RoomForWhatIsSeenIsRoomForTheResidentImage) {
  for (const bool of_one_colour : {false, true}) {
    StreamRig rig(bake(test::long_street(of_one_colour)), 1.0);
    const auto chunks = static_cast<uint32_t>(rig.stream().file().chunks().size());
    size_t coarse = 0;
    for (int i = 0; i < 12; ++i) {
      SCOPED_TRACE(i);
      const Vec3d eye{300.0 * i - 1650, -3, -60};
      FrameInput input = frame_input(look(eye, eye + Vec3d{0.1 * (i % 4), 0.1, 1}, 96, 64, 12),
                                     of_one_colour ? 0 : 0.5);
      const Frame whole = render(rig.whole, input);
      input.wait_resident = true;
      rig.give_room(chunks);
      expect_same_bits(render(rig.part, input), whole);
      const auto seen = static_cast<uint32_t>(rig.stream().counters().need.seen);
      const auto need = static_cast<uint32_t>(rig.stream().counters().need.chunks);
      const uint32_t enough = seen + rig.stream().pinned();
      for (const uint32_t room : {enough, (enough + need) / 2}) {
        rig.give_room(room);
        const Frame part = render(rig.part, input);
        expect_same_bits(part, whole);
        ASSERT_TRUE(is_cut(*whole_tree(*rig.resident), part.cut));
        coarse += part.stats.missing != 0;
      }
      rig.give_room(seen);
      EXPECT_EQ(test::error_code([&] { render(rig.part, input); }), ErrorCode::over_budget);
    }
    EXPECT_GT(coarse, 12u);
  }
}

// What viewers will need takes no room from what one sees now, however families of nodes lie.
TEST(Streaming, RoomForWhatIsSeenIsEnoughBesideViewersWhoMove) {
  StreamRig rig(random_scene(8000, 12), 1.0);
  const SceneFile& file = rig.stream().file();
  const uint32_t top = SceneStream::top_chunks(file);
  const PoolRoom all = RecordRoom(file).of(static_cast<uint32_t>(file.chunks().size()));
  uint32_t top_blocks = 0;
  for (uint32_t chunk = 0; chunk < top; ++chunk)
    top_blocks +=
        stage_chunk(file.read_chunk(chunk), chunk, file.tiers(), file.name()).record_blocks();
  std::mt19937 random(6);
  const auto within = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * test::unit(random));
  };
  struct Other {
    Viewer now, ahead;
  };
  std::array<Other, 3> others;
  const auto anywhere = [&](float target_size, bool ahead) {
    const Vec3f eye{within(-20, 20), -6, within(-20, 20)};
    Wedge wedge{eye, {}};
    for (Vec3f& normal : wedge.normals) normal = {within(-1, 1), within(-1, 1), within(-1, 1)};
    return Viewer{{eye, target_size}, {wedge}, ahead};
  };
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    for (Other& other : others) {
      other = {anywhere(within(0.1, 0.5), false), anywhere(within(0.01, 0.05), true)};
      rig.stream().look(&other, {other.now});
    }
    const Vec3d eye{within(-20, 20), -6, within(-20, 20)};
    FrameInput input = frame_input(look(eye, {0, 0, 0}, 16, 12, 75), 1 + i % 4);
    const Frame whole = render(rig.whole, input);
    input.wait_resident = true;
    rig.stream().resize(all, top, rig.workers);
    render(rig.part, input);
    // What a family of nodes needs is counted by the next plan.
    rig.stream().look(&all, {Viewer{}});
    rig.stream().look(&all, {});
    render(rig.part, input);
    const ResidencyNeed need = rig.stream().counters().need;
    for (const Other& other : others) rig.stream().look(&other, {other.now, other.ahead});
    for (const PoolRoom tight :
         {PoolRoom{top + static_cast<uint32_t>(need.seen), all.blocks, all.pages},
          PoolRoom{all.slots, top_blocks + static_cast<uint32_t>(need.seen_blocks), all.pages}}) {
      rig.stream().resize(tight, top, rig.workers);
      expect_same_bits(render(rig.part, input), whole);
    }
    ASSERT_FALSE(HasFailure());
  }
}

// Whoever stands where a scene was said to be looked at first misses nothing that is large from
// there, whichever way it turns; of a scene of which as much was read from the top, it does.
TEST_P(StreamingOfTree, WhatIsLargeFromTheStartIsThereInTheFirstFrame) {
  const Vec3d origin{1000, 0, -2000};
  GaussianCloud cloud = test::random_cloud(60000, 8, 1);
  for (float& x : cloud.position) x *= 20;
  test::paint(cloud);
  cloud.origin = {origin.x, origin.y, origin.z};
  StreamRig rig(bake(cloud), 1.0);
  const uint64_t first_bytes = rig.bytes.size() / 4;
  for (int i = 0; i < 4; ++i) {
    const Vec3d out{std::cos(1.5 * i), 0, std::sin(1.5 * i)};
    const Vec3d eye = origin + 40.0 * out;
    const FrameInput input = frame_input(look(eye, eye + out, 96, 64, 60), 20);
    const auto missing = [&](std::optional<Vec3d> start) {
      const auto scene = rig.open(test::source_of(rig.bytes), 0.5, first_bytes, start);
      View view(scene, *rig.backend, {}, rig.memory(), rig.workers);
      const Frame frame = render(view, input);
      EXPECT_TRUE(is_cut(*whole_tree(*rig.resident), frame.cut));
      const auto& chunks = scene->stream->file().chunks();
      const uint64_t top = chunks[scene->stream->pinned()].offset - chunks[0].offset;
      EXPECT_LE(scene->stream->counters().bytes_read, top + first_bytes + (1 << 19));
      // What is large is less than what is read.
      while (scene->stream->step()) continue;
      EXPECT_LT(8 * scene->stream->counters().need.chunks, chunks.size());
      return frame.stats.missing;
    };
    EXPECT_EQ(missing(eye), 0u);
    EXPECT_GT(missing({}), 0u);
  }
}

// Room for less than is seen: the most urgent stays, and nothing is read twice in vain.
TEST(Streaming, TooLittleRoomIsCoarseAndStill) {
  StreamRig rig(random_scene(20000, 6), 0.05);
  const FrameInput input = frame_input(look({0, -2, -12}, {0, 0, 0}, 61, 45), 1);
  const Frame frame = rig.settle(input);
  ASSERT_TRUE(is_cut(*whole_tree(*rig.resident), frame.cut));
  EXPECT_GT(frame.stats.missing, 0u);
  const uint64_t read = rig.stream().counters().bytes_read;
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(render(rig.part, input).cut, frame.cut);
    EXPECT_EQ(rig.work(), 0u);
  }
  EXPECT_EQ(rig.stream().counters().bytes_read, read);
}

// What a search goes on from is worth no less than what it would find from nothing.
TEST(Streaming, TheTemporalCutIsTheStreamingOne) {
  StreamRig rig(random_scene(6000, 8), 0.2);
  View streaming(rig.streamed, *rig.backend, searching(Search::streaming), rig.memory(),
                 rig.workers);
  View visit(rig.streamed, *rig.backend, searching(Search::temporal_visit), rig.memory(),
             rig.workers);
  size_t compared = 0;
  for (const FrameInput& input : walk(80, 5, 4)) {
    const Frame temporal = render(rig.part, input);
    const uint64_t version = rig.stream().version();
    const Frame other = render(streaming, input), all = render(visit, input);
    rig.work(4);
    if (rig.stream().version() != version) continue;
    ++compared;
    ASSERT_EQ(temporal.cut, other.cut);
    ASSERT_EQ(temporal.stats.missing, other.stats.missing);
    ASSERT_EQ(all.cut, other.cut);
  }
  EXPECT_GT(compared, 40u);
}

// Tables with places for a part of the subtrees, whose pages other pages take.
// So that a frame has little to link where much comes.
TEST(Streaming, WhatComesIsLinkedBetweenFrames) {
  StreamRig rig(random_scene(4000, 3), 1.0);
  StreamingDesc desc;
  desc.first_bytes = 0;
  const auto scene = open_streamed(test::source_of(rig.bytes), desc, *rig.backend,
                                   StreamRig::memory(), rig.workers);
  SceneStream& stream = *scene->stream;
  const size_t chunks = stream.file().chunks().size();
  ASSERT_LT(stream.counters().resident, chunks / 6);
  stream.look(&rig, {{{Vec3f{0, -2, 0}, 1e-6f}, {}, false}});
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (stream.counters().resident < chunks / 3 && std::chrono::steady_clock::now() < patience)
    std::this_thread::yield();
  EXPECT_GE(stream.counters().resident, chunks / 3);
  View part(scene, *rig.backend, {}, StreamRig::memory(), rig.workers);
  FrameInput input = walk(1, 1, 6).front();
  input.wait_resident = true;
  expect_same_bits(render(part, input), render(rig.whole, input));
}

TEST(Streaming, WhatAViewKeepsByPlaceIsRightHoweverSeldomItDraws) {
  GaussianCloud cloud = test::random_cloud(20000, 6, 1);
  for (float& x : cloud.position) x *= 40;
  StreamRig rig(test::bake(cloud), 0.1, {}, kDefaultChunkBytes, Quality::compact);
  const SearchTree& search = rig.streamed->search;
  const SceneFile& file = rig.stream().file();
  PoolRoom room = RecordRoom(file).of(static_cast<uint32_t>(rig.streamed->slot_ids.size()));
  room.pages = room.pages / 2;  // fewer than any so many chunks take, but enough for these
  const auto view = [&](Search kind) {
    return View(rig.streamed, *rig.backend, searching(kind), rig.memory(), rig.workers);
  };
  View streaming = view(Search::streaming), seldom = view(Search::temporal);
  rig.stream().resize(room, SceneStream::pinned_chunks(file, room.slots), rig.workers);
  ASSERT_LT(search.subtrees.size(), size_t{search.subtree_count()} / 3);
  std::mt19937 random(3);
  const auto within = [&](double end) { return end * (2 * test::unit(random) - 1); };
  size_t compared = 0, taken = 0;
  std::map<uint32_t, uint32_t> page_at;  // by place
  Vec3d eye{0, -5, 0};
  for (int frame = 0; frame < 120; ++frame) {
    eye = frame % 4 == 0 ? Vec3d{within(400), -5, within(400)} : eye + Vec3d{within(2), 0, 1};
    const FrameInput input = frame_input(look(eye, {0, 0, 0}, 61, 45, 75), 8);
    const Frame temporal = render(rig.part, input);
    const uint64_t version = rig.stream().version();
    const Frame other = render(streaming, input);
    const Frame late = frame % 9 == 0 ? render(seldom, input) : other;
    for (uint32_t page = 0; page < search.pages.size(); ++page) {
      const uint32_t place = search.pages[page];
      if (place != 0) taken += std::exchange(page_at[place], page) != page;
    }
    rig.work(30);
    if (rig.stream().version() != version) continue;
    ++compared;
    ASSERT_EQ(temporal.cut, other.cut);
    ASSERT_EQ(late.cut, other.cut);
    ASSERT_EQ(temporal.stats.missing, other.stats.missing);
  }
  EXPECT_GT(compared, 60u);
  EXPECT_GT(taken, 2 * page_at.size()) << "places stayed with their pages";
}

}  // namespace
}  // namespace voyager::streaming_test
