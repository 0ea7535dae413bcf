// A streamed scene on the device against the resident one and against the host's searches: the
// same bits once all that is needed has come, and before that a cut of what is there.
#include <algorithm>
#include <atomic>
#include <thread>

#include "runtime/base/error.h"
#include "runtime/frame/whole_tree.h"
#include "tests/gpu/splat_test.h"
#include "tests/support/random_trees.h"
#include "tests/support/stream_rig.h"
#include "tests/support/tree_clouds.h"
#include "tests/support/tree_rules.h"

namespace voyager::test {
namespace streaming_test {
namespace {

constexpr size_t kGranularity = size_t{4} << 20;  // of cudaMalloc and what it keeps

class Streaming : public SplatTest {
 protected:
  // share: of the memory that all chunks take, below 1; at least room for the top.
  std::shared_ptr<Scene> open(const Bytes& bytes, double share, unsigned readers = 0) {
    return open(*cuda, bytes, share, readers);
  }
  std::shared_ptr<Scene> open(Backend& backend, const Bytes& bytes, double share,
                              unsigned readers = 0) {
    StreamingDesc desc;
    desc.readers = readers;
    desc.first_bytes = 0;
    desc.budget = share < 1 ? budget_of(backend, bytes, share) : 0;
    return open_streamed(source_of(bytes), desc, backend, memory(), workers);
  }

  uint64_t budget_of(Backend& backend, const Bytes& bytes, double share) {
    const SceneFile file(source_of(bytes));
    const RoomBytes room = backend.room_bytes(*resident(bytes), SceneStream::slot_shape(file));
    const auto chunks = static_cast<double>(file.chunks().size());
    return room.of(RecordRoom(file).of(
        std::max(SceneStream::top_chunks(file), static_cast<uint32_t>(share * chunks + 1))));
  }

  std::shared_ptr<const Scene> resident(const Bytes& bytes) {
    return load_scene(source_of(bytes), memory(), workers);
  }

  static std::pmr::memory_resource* memory() { return std::pmr::get_default_resource(); }
};

Bytes cloud_bytes(size_t count, uint32_t seed, int degree, Quality quality = Quality::lossless) {
  return scene_bytes(bake(random_cloud(share_of(count), seed, degree)), quality, 0, kMinChunkBytes);
}

// Small steps, a teleport now and then.
std::vector<FrameInput> walk(size_t frames, double tau, uint32_t seed) {
  std::mt19937 random(seed);
  Vec3d eye{3, -6, -24}, way{0.1, 0, 0.2};
  std::vector<FrameInput> path;
  for (size_t i = 0; i < share_of(frames); ++i) {
    if (i % 16 == 15) eye = {40.0 * unit(random) - 20, -5, 40.0 * unit(random) - 20};
    if (i % 5 == 0) way = {unit(random) - 0.5, 0.3 * unit(random) - 0.15, unit(random) - 0.5};
    eye = eye + way;
    path.push_back(frame_input(look(eye, Vec3d{0.1, 0.2, 2}, 160, 100), tau + 0.01 * (i % 9)));
  }
  return path;
}

void expect_same_frame(const Frame& part, const Frame& whole) {
  ASSERT_EQ(part.cut, whole.cut);
  expect_same_bits(part, whole);
  EXPECT_EQ(part.stats.missing, 0u);
  EXPECT_EQ(part.stats.cut_size, whole.stats.cut_size);
  EXPECT_EQ(part.stats.splats, whole.stats.splats);
  EXPECT_EQ(part.stats.pairs_after, whole.stats.pairs_after);
}

std::vector<NamedDesc> searches() {
  std::vector<NamedDesc> all(5);
  all[0].name = "temporal";
  all[1] = {"temporal_visit", {.search = Search::temporal_visit}};
  all[2] = {"streaming", {.search = Search::streaming}};
  all[3] = {"ex2, what is hidden left out",
            {.exponential = Exponential::ex2, .occlusion = Occlusion::on}};
  all[4] = {"3dgs", {.splatting = Splatting::baseline_3dgs}};
  return all;
}

TEST_F(Streaming, FramesThatWaitEqualResidentOnes) {
  const std::vector<std::pair<int, Quality>> stored = {
      {0, Quality::lossless}, {1, Quality::lossless}, {2, Quality::compact}, {3, Quality::compact}};
  for (const auto& [degree, quality] : stored) {
    const Bytes bytes = cloud_bytes(20000, 6, degree, quality);
    const auto whole = resident(bytes);
    for (const unsigned readers : {0u, 2u})
      for (const NamedDesc& named : searches()) {
        SCOPED_TRACE(named.name + ", readers " + std::to_string(readers) + ", degree " +
                     std::to_string(degree));
        const auto streamed = open(bytes, 1, readers);
        const auto all = view(whole, named.desc), part = view(streamed, named.desc);
        for (FrameInput input : walk(40, 4, 1)) {
          const Frame expected = render(*all, input);
          input.wait_resident = true;
          expect_same_frame(render(*part, input), expected);
          if (HasFatalFailure()) return;
        }
      }
  }
}

// Too large for binary16, for all of the scene alike.
TEST_F(Streaming, LargeCoefficientsAreKeptAsAResidentSceneKeepsThem) {
  GaussianCloud cloud = random_cloud(6000, 7, 1);
  cloud.sh[17] = 9.5f;
  const Bytes bytes = scene_bytes(bake(cloud), Quality::lossless, 0, kMinChunkBytes);
  const auto all = view(resident(bytes)), part = view(open(bytes, 1));
  for (FrameInput input : walk(20, 4, 2)) {
    const Frame expected = render(*all, input);
    input.wait_resident = true;
    expect_same_frame(render(*part, input), expected);
  }
}

TEST_F(Streaming, InstancesOfOneSceneShareItsPool) {
  const Bytes bytes = cloud_bytes(12000, 8, 1);
  const auto whole = resident(bytes);
  const std::shared_ptr<const Scene> streamed = open(bytes, 1, 2);
  View all(Scenes{whole, whole}, *cuda, {}, memory(), workers);
  View part(Scenes{streamed, streamed}, *cuda, {}, memory(), workers);
  for (FrameInput input : walk(30, 5, 3)) {
    input.instances.resize(2);
    input.instances[1].position = {9, 0, 4};
    const Frame expected = render(all, input);
    input.wait_resident = true;
    expect_same_frame(render(part, input), expected);
    EXPECT_TRUE(std::ranges::equal(part.cut(1), all.cut(1)));
  }
}

// Frames that wait for nothing, with little room and few reads between them.
TEST_F(Streaming, EveryFrameDrawsACut) {
  const Bytes bytes = cloud_bytes(20000, 9, 1);
  const auto whole = resident(bytes);
  const auto tree = whole_tree(*whole);
  for (const double share : {0.02, 0.1, 0.4})
    for (const size_t steps : {0u, 2u, 20u}) {
      SCOPED_TRACE(std::to_string(share) + ", steps " + std::to_string(steps));
      const auto streamed = open(bytes, share);
      const auto part = view(streamed);
      size_t missing = 0;
      for (const FrameInput& input : walk(60, 4, 4)) {
        const Frame frame = render(*part, input);
        ASSERT_TRUE(is_cut(*whole_tree(*whole), frame.cut));
        expect_no_nan(frame);
        EXPECT_EQ(frame.stats.cut_size, frame.cut.size());
        const uint64_t stand_ins = static_cast<uint64_t>(
            std::count_if(frame.cut.begin(), frame.cut.end(), [&](uint32_t n) {
              return !tree->is_leaf(n) &&
                     tree->screen_size(n, frame.stats.cut_centre) >= frame.stats.tau_star;
            }));
        ASSERT_EQ(frame.stats.missing, stand_ins);
        missing += stand_ins;
        for (size_t i = 0; i < steps && streamed->stream->step(); ++i) continue;
      }
      EXPECT_GT(missing, 0u);
    }
}

// A cut is read when somebody asks. What has come meanwhile, into slots of what went, changes no
// cut that was drawn before.
TEST_F(Streaming, ACutMayBeReadAfterItsChunksHaveGone) {
  const Bytes bytes = cloud_bytes(20000, 9, 1);
  const auto whole = resident(bytes);
  const auto streamed = open(bytes, 0.3);
  const auto stays = view(streamed), moves = view(streamed);
  const std::vector<FrameInput> path = walk(60, 4, 4);
  const auto draw_and_read = [&](View& by, const FrameInput& input) {
    Image none;
    none.format = ColorFormat::none;
    none.width = 160, none.height = 100;
    by.render(input, none);
    while (streamed->stream->step()) continue;
  };
  for (size_t i = 0; i < 20; ++i) draw_and_read(*stays, path[i]);
  const uint64_t gone = streamed->stream->counters().chunks.evicted;
  for (size_t i = 20; i < path.size(); ++i) draw_and_read(*moves, path[i]);
  EXPECT_GT(streamed->stream->counters().chunks.evicted, gone + 10);
  const std::vector<uint32_t> cut(stays->cut().begin(), stays->cut().end());
  EXPECT_GT(cut.size(), 100u);
  EXPECT_TRUE(is_cut(*whole_tree(*whole), cut));
}

// Reads of what is around end after the cut is whole.
StreamCounters counters_at_rest(const SceneStream& stream) {
  for (StreamCounters before = stream.counters();;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const StreamCounters now = stream.counters();
    if (now.bytes_read == before.bytes_read) return now;
    before = now;
  }
}

TEST_F(Streaming, AStandingViewerConvergesToTheResidentFrameAndThenNothingMoves) {
  const Bytes bytes = cloud_bytes(20000, 10, 1);
  const auto streamed = open(bytes, 1, 2);
  const auto all = view(resident(bytes)), part = view(streamed);
  for (const FrameInput& input : walk(5, 4, 5)) {
    const Frame expected = render(*all, input);
    Frame frame = render(*part, input);
    for (int i = 0; i < 2000 && frame.cut != expected.cut; ++i) frame = render(*part, input);
    expect_same_frame(frame, expected);
    const StreamCounters before = counters_at_rest(*streamed->stream);
    frame = render(*part, input);
    EXPECT_EQ(frame.stats.entered + frame.stats.left, 0u);
    EXPECT_EQ(streamed->stream->counters().bytes_read, before.bytes_read);
  }
}

// What is seen is there; what is around may be coarse.
TEST_F(Streaming, RoomForWhatIsSeenIsRoomForTheResidentImage) {
  for (const NamedRule& named : all_rules()) {
    SCOPED_TRACE(named.name);
    const Bytes bytes =
        scene_bytes(bake(long_street(false), named.rule), Quality::lossless, 0, kMinChunkBytes);
    const auto whole = resident(bytes);
    const auto all = view(whole), part = view(open(bytes, 0.4, 2));
    size_t coarse = 0, refused = 0;
    for (int i = 0; i < 12; ++i) {
      const Vec3d eye{300.0 * i - 1650, -3, -60};
      FrameInput input =
          frame_input(look(eye, eye + Vec3d{0.1 * (i % 4), 0.1, 1}, 96, 64, 12), 0.5);
      const Frame expected = render(*all, input);
      input.wait_resident = true;
      try {
        const Frame frame = render(*part, input);
        expect_same_bits(frame, expected);
        ASSERT_TRUE(is_cut(*whole_tree(*whole), frame.cut));
        coarse += frame.stats.missing != 0;
      } catch (const Error& error) {
        ASSERT_EQ(error.code(), ErrorCode::over_budget) << error.what();
        ++refused;
      }
    }
    EXPECT_GT(coarse, 0u);
    EXPECT_LT(refused, 12u);
  }
}

// Each of two views on a thread of its own flies where the other does not, with room for neither:
// chunks go while frames are in flight. A frame whose cut is the resident one is its image.
TEST_F(Streaming, ViewsOnTwoThreadsDrawWhatTheyFindWhileChunksGo) {
  const Bytes bytes = cloud_bytes(30000, 11, 1);
  const auto whole = resident(bytes);
  for (const double share : {0.3, 0.7}) {
    const auto streamed = open(bytes, share, 2);
    const auto fly = [&](uint32_t seed, std::atomic<size_t>& same) {
      Workers own(1);
      View all(whole, *cuda, {}, memory(), own), part(streamed, *cuda, {}, memory(), own);
      for (const FrameInput& input : walk(150, 25, seed)) {
        const Frame expected = render(all, input);
        for (int i = 0; i < 3; ++i) {
          const Frame frame = render(part, input);
          EXPECT_TRUE(is_cut(*whole_tree(*whole), frame.cut));
          if (frame.cut != expected.cut) continue;
          expect_same_bits(frame, expected);
          ++same;
        }
      }
    };
    std::atomic<size_t> same{0};
    std::thread other([&] { fly(21, same); });
    fly(22, same);
    other.join();
    EXPECT_GT(streamed->stream->counters().chunks.evicted, 0u);
    RecordProperty("frames_compared_" + std::to_string(share), std::to_string(same.load()));
  }
}

// --- searches by themselves, in step with the host's ---

struct Side {
  std::shared_ptr<Scene> scene;
  std::unique_ptr<SceneSearch> search;
};

struct Found {
  std::vector<uint32_t> cut;
  std::vector<float> weights;
  SearchStats stats;
};

Found run(const Side& side, const CutQuery& query) {
  const auto hold = side.scene->stream->hold();
  Found found;
  side.search->run(query);
  side.search->read(found.cut, found.weights);
  found.stats = side.search->stats();
  return found;
}

void expect_same(const Found& a, const Found& b) {
  ASSERT_EQ(a.cut, b.cut);
  EXPECT_EQ(different_bits(a.weights, b.weights), 0u) << "weights";
  EXPECT_EQ(a.stats.stand_ins, b.stats.stand_ins);
  // A device counts a node that has gone and come again in one step as both.
  EXPECT_EQ(a.stats.entered - a.stats.left, b.stats.entered - b.stats.left);
}

class StreamingSearch : public Streaming {
 protected:
  // On the device and on the host, with as many slots.
  std::array<Side, 2> open_both(const Bytes& bytes, double share, Search kind) {
    std::array<Side, 2> sides;
    Backend* const backends[] = {cuda.get(), cpu.get()};
    for (size_t i = 0; i < 2; ++i) {
      sides[i].scene = open(*backends[i], bytes, share);
      sides[i].search = other_search(i, sides[i].scene, kind);
    }
    return sides;
  }
  std::unique_ptr<SceneSearch> other_search(size_t side, const std::shared_ptr<Scene>& scene,
                                            Search kind) {
    return (side == 0 ? *cuda : *cpu).create_search(scene, {kind, true}, memory(), workers);
  }
  static void move(const std::array<Side, 2>& sides, const CutQuery& query, size_t steps) {
    for (const Side& side : sides) {
      SceneStream& stream = *side.scene->stream;
      stream.look(&side, {Viewer{query, {}, false}});
      for (size_t i = 0; i < steps && stream.step(); ++i) continue;
      stream.commit();
    }
  }
};

std::vector<CutQuery> queries(const LodTree& tree, std::mt19937& random, int count) {
  std::vector<CutQuery> all;
  const float targets[] = {1e-30f, 1e-4f, 0.003f, 0.02f, 0.3f, 5.0f, INFINITY};
  Vec3f centre{};
  for (int i = 0; i < share_of(count); ++i) {
    const NodeRecord& r = tree.records[random() % tree.size()];
    if (i % 4 == 0) centre = 0.5f * (r.box_min + r.box_max);
    centre = centre + Vec3f{0.3f * unit(random), 0.1f, 0.2f * unit(random)};
    all.push_back({centre, targets[random() % 7]});
  }
  return all;
}

TEST_F(StreamingSearch, EqualTheHostsOnTreesOfEveryShapeStepByStep) {
  std::mt19937 random(1);
  for (const TreeShape shape : kTreeShapes)
    for (const uint32_t nodes : {1u, 40u, 3000u})
      for (const Extents extents : {Extents::longest_side, Extents::any})
        for (const double share : {0.1, 0.5, 1.0}) {
          SCOPED_TRACE(name_of(shape) + " of " + std::to_string(nodes) + ", " +
                       std::to_string(share));
          const BakedScene baked =
              baked_of(random_tree(shape, share_of(nodes), 7 + nodes, extents));
          const Bytes bytes = scene_bytes(baked, Quality::lossless, 0, kMinChunkBytes);
          const auto sides = open_both(bytes, share, Search::temporal);
          for (const CutQuery& query : queries(baked.tree, random, 24)) {
            move(sides, query, 3);
            const Found device = run(sides[0], query);
            ASSERT_TRUE(is_cut(baked.tree, device.cut));
            expect_same(device, run(sides[1], query));
            if (HasFatalFailure()) return;
          }
        }
}

// A search that rests while another moves finds what has gone and come again meanwhile, or more
// changes than are kept.
TEST_F(StreamingSearch, EqualTheHostsAfterARest) {
  const BakedScene baked = baked_of(random_tree(TreeShape::four_way, share_of(8000), 3));
  const Bytes bytes = scene_bytes(baked, Quality::lossless, 0, kMinChunkBytes);
  const CutQuery here{{60, 0, 10}, 0.02f}, there{{-60, 5, -10}, 0.02f};
  for (const Search kind : {Search::temporal, Search::temporal_visit, Search::streaming})
    for (const double share : {0.1, 0.3})
      for (const size_t frames : {2u, 9u, 100u}) {
        SCOPED_TRACE(std::to_string(share) + ", frames " + std::to_string(frames));
        const auto sides = open_both(bytes, share, kind);
        for (int round = 0; round < 6; ++round) {
          for (size_t i = 0; i < frames; ++i) move(sides, i < frames / 2 ? there : here, 8);
          const Found device = run(sides[0], here);
          ASSERT_TRUE(is_cut(baked.tree, device.cut));
          expect_same(device, run(sides[1], here));
          if (HasFatalFailure()) return;
        }
      }
}

// --- budgets ---

TEST_F(Streaming, APoolStaysWithinItsBudgetAndLeavesNothing) {
  const Bytes bytes = cloud_bytes(60000, 12, 3);
  const auto round = [&](double share) {
    const uint64_t budget = budget_of(*cuda, bytes, share);
    const size_t before = free_bytes();
    const auto streamed = open(bytes, share);
    const size_t taken = before - free_bytes();
    EXPECT_LE(taken, budget + kGranularity);
    EXPECT_GE(taken + kGranularity, budget / 2);
    const auto part = view(streamed);
    const std::vector<FrameInput> path = walk(40, 4, 6);
    const auto fly = [&] {
      for (const FrameInput& input : path) {
        render(*part, input);
        while (streamed->stream->step()) continue;
      }
    };
    fly(), fly();
    const size_t flown = free_bytes();
    fly();
    EXPECT_EQ(free_bytes(), flown);
  };
  round(0.5);  // kernels are loaded once
  const size_t free = free_bytes();
  for (const double share : {0.1, 0.5, 1.0}) round(share);
  EXPECT_EQ(free_bytes(), free);
}

TEST_F(Streaming, AnotherBudgetHoldsFromThenOn) {
  const Bytes bytes = cloud_bytes(20000, 13, 1);
  const auto whole = resident(bytes);
  const auto streamed = open(bytes, 0.3);
  const auto all = view(whole), part = view(streamed);
  const std::vector<FrameInput> path = walk(60, 4, 7);
  for (size_t i = 0; i < path.size(); ++i) {
    const double shares[] = {0.3, 0.05, 1, 0.5};
    if (i % 10 == 9)
      streamed->stream->set_budget(budget_of(*cuda, bytes, shares[i / 10 % 4]), workers);
    const Frame frame = render(*part, path[i]);
    ASSERT_TRUE(is_cut(*whole_tree(*whole), frame.cut));
    EXPECT_EQ(frame.stats.cut_size, frame.cut.size());
    while (streamed->stream->step()) continue;
  }
  streamed->stream->set_budget(0, workers);
  FrameInput input = path.back();
  const Frame expected = render(*all, input);
  input.wait_resident = true;
  expect_same_frame(render(*part, input), expected);
}

// A slot for each chunk, and few blocks of records: then for all, scattered by what came and went.
TEST_F(Streaming, RecordsMayRunOutBeforeSlots) {
  const Bytes bytes = cloud_bytes(20000, 17, 3, Quality::compact);
  const auto whole = resident(bytes);
  const auto streamed = open(bytes, 1);
  const auto all = view(whole), part = view(streamed);
  const SceneFile& file = streamed->stream->file();
  const RecordRoom records(file);
  const uint32_t top = SceneStream::top_chunks(file);
  const PoolRoom room = records.of(static_cast<uint32_t>(file.chunks().size()));
  PoolRoom few = room;
  few.blocks = std::max(room.blocks / 3, (top + 1) * records.most_blocks());
  streamed->stream->resize(few, top, workers);
  size_t missing = 0;
  for (const FrameInput& input : walk(60, 4, 8)) {
    const Frame frame = render(*part, input);
    ASSERT_TRUE(is_cut(*whole_tree(*whole), frame.cut));
    missing += frame.stats.missing;
    while (streamed->stream->step()) continue;
    EXPECT_LT(streamed->stream->counters().resident, few.slots);
  }
  EXPECT_GT(missing, 0u);
  streamed->stream->set_budget(budget_of(*cuda, bytes, 0.6), workers);
  for (const FrameInput& input : walk(60, 12, 9)) {
    const Frame expected = render(*all, input);
    Frame frame;
    do frame = render(*part, input);
    while (streamed->stream->step());
    if (frame.stats.missing == 0) expect_same_bits(frame, expected);
  }
}

// Of more children than a shape has room to say, and in slots of more places than a byte names.
TEST_F(Streaming, LargeFamiliesAndLargeChunksBlendAsResidentOnes) {
  for (const TreeShape shape : {TreeShape::star, TreeShape::star_of_stars})
    for (const uint32_t chunk_bytes : {kMinChunkBytes, 300 * uint32_t{sizeof(NodeRecord)}}) {
      SCOPED_TRACE(name_of(shape) + (", " + std::to_string(chunk_bytes)));
      const Bytes bytes = scene_bytes(baked_of(random_tree(shape, share_of(20000), 18)),
                                      Quality::compact, 0, chunk_bytes);
      const auto whole = resident(bytes);
      ASSERT_FALSE(whole->large_families.empty());
      const auto streamed = open(bytes, 1);
      const auto all = view(whole), part = view(streamed);
      for (FrameInput input : walk(20, 20, 10)) {
        const Frame expected = render(*all, input);
        input.wait_resident = true;
        expect_same_frame(render(*part, input), expected);
      }
    }
}

TEST_F(Streaming, TooSmallABudgetIsRefused) {
  const Bytes bytes = cloud_bytes(5000, 14, 1);
  StreamingDesc desc;
  desc.budget = 1000;
  EXPECT_EQ(error_code([&] { open_streamed(source_of(bytes), desc, *cuda, memory(), workers); }),
            ErrorCode::over_budget);
}

// --- refusals ---

TEST_F(Streaming, WhatNeedsTheWholeTreeIsRefused) {
  const Bytes bytes = cloud_bytes(2000, 15, 1);
  const std::shared_ptr<const Scene> streamed = open(bytes, 1);
  for (const PipelineDesc& desc :
       {PipelineDesc{.lod = Lod::all_leaves}, PipelineDesc{.lod = Lod::blocks},
        PipelineDesc{.lod = Lod::levels}, PipelineDesc{.search = Search::exhaustive}})
    EXPECT_EQ(error_code([&] { view(streamed, desc); }), ErrorCode::unsupported);
  EXPECT_EQ(error_code([&] {
              cuda->create_search(streamed, {Search::exhaustive, true}, memory(), workers);
            }),
            ErrorCode::unsupported);
}

TEST_F(Streaming, ASceneInTheHostsMemoryIsRefused) {
  const Bytes bytes = cloud_bytes(2000, 16, 1);
  const std::shared_ptr<const Scene> streamed = open(*cpu, bytes, 1);
  EXPECT_EQ(error_code([&] { view(streamed); }), ErrorCode::unsupported);
}

}  // namespace
}  // namespace streaming_test
}  // namespace voyager::test
