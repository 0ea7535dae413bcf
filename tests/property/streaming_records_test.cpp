// A pool whose room for search records runs out before its slots do, and what else a chunk brings
// beside its Gaussians.
#include <cstring>
#include <random>

#include "runtime/frame/whole_tree.h"
#include "tests/support/random_trees.h"
#include "tests/support/stream_rig.h"

namespace voyager::streaming_records_test {
namespace {

using test::expect_same_bits;
using test::Frame;
using test::frame_input;
using test::is_cut;
using test::look;
using test::render;
using test::StreamRig;

const test::Bytes& scene() {
  static const test::Bytes bytes = test::scene_bytes(test::bake(test::random_cloud(8000, 12, 1)),
                                                     Quality::compact, 0, kMinChunkBytes);
  return bytes;
}

// A slot for each chunk, but few blocks of records: the share of those that all chunks take.
class FewRecords {
 public:
  explicit FewRecords(double share) : rig(scene(), 1.0) { leave(share); }

  void leave(double share) {
    const SceneFile& file = rig.stream().file();
    const RecordRoom records(file);
    const uint32_t top = SceneStream::top_chunks(file);
    room = records.of(static_cast<uint32_t>(file.chunks().size()));
    room.blocks =
        std::max(static_cast<uint32_t>(share * room.blocks), (top + 1) * records.most_blocks());
    rig.stream().resize(room, top, rig.workers);
  }

  StreamRig rig;
  PoolRoom room{};
};

FrameInput from(const Vec3d& eye, double tau) {
  return frame_input(look(eye, {0, 0, 0}, 61, 45, 75), tau);
}

TEST(StreamingRecords, WhereTheyRunOutFramesAreCoarseAndNothingMoves) {
  FewRecords few(0.4);
  const FrameInput input = from({0, -2, -12}, 1);
  const Frame frame = few.rig.settle(input);
  ASSERT_TRUE(is_cut(*whole_tree(*few.rig.resident), frame.cut));
  EXPECT_GT(frame.stats.missing, 0u);
  const StreamCounters before = few.rig.stream().counters();
  EXPECT_LT(before.resident, before.slots);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(render(few.rig.part, input).cut, frame.cut);
    EXPECT_EQ(few.rig.work(), 0u);
  }
  EXPECT_EQ(few.rig.stream().counters().bytes_read, before.bytes_read);
}

// By what was read so far; of the rest the refusal says what is likely.
TEST(StreamingRecords, AFrameThatWaitsSaysWhatIsEnough) {
  FewRecords few(0.4);
  FrameInput input = from({0, -2, -12}, 1);
  input.wait_resident = true;
  const Frame whole = render(few.rig.whole, input);
  for (int tries = 0; tries < 3; ++tries) {
    std::string message;
    try {
      return expect_same_bits(render(few.rig.part, input), whole);
    } catch (const Error& error) {
      ASSERT_EQ(error.code(), ErrorCode::over_budget) << error.what();
      message = error.what();
    }
    const size_t expected = message.find("expected ");
    ASSERT_NE(expected, std::string::npos) << message;
    few.rig.streamed->stream->set_budget(
        static_cast<uint64_t>(std::stod(message.substr(expected + 9)) * 1e6), few.rig.workers);
  }
  FAIL() << "it was refused three times";
}

// A chunk's records lie in blocks that others have left here and there.
TEST(StreamingRecords, ScatteredOnesAreTheSame) {
  StreamRig rig(scene(), 0.5);
  std::mt19937 random(3);
  size_t scattered = 0;
  for (int i = 0; i < 60; ++i) {
    const Vec3d eye{40.0 * test::unit(random) - 20, -6, 40.0 * test::unit(random) - 20};
    const Frame frame = rig.settle(from(eye, 4));
    ASSERT_TRUE(is_cut(*whole_tree(*rig.resident), frame.cut));
    if (frame.stats.missing == 0) expect_same_bits(frame, render(rig.whole, from(eye, 4)));
    for (const SearchSubtree& s : rig.streamed->search.subtrees)
      scattered += s.entry != kNotLinked && s.scattered();
  }
  EXPECT_GT(scattered, 100u);
}

// There are fewer blocks then than even what is pinned may need, or fewer leaves than nodes that a
// cut has.
class ClaimedLeaves : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Claims, ClaimedLeaves, ::testing::Values(false, true),
                         [](const auto& few) { return few.param ? "TooFew" : "TooMany"; });

TEST_P(ClaimedLeaves, AreNoCrash) {
  test::Bytes bytes = scene();
  FileHeader header;
  std::memcpy(&header, bytes.data(), sizeof header);
  header.leaf_count = GetParam() ? 1 : header.node_count - 1;
  std::memcpy(bytes.data(), &header, sizeof header);
  bytes = test::sealed(bytes);
  const auto backend = create_cpu_backend();
  Workers workers(1);
  StreamingDesc desc;
  desc.readers = 0;
  const auto open_and_draw = [&] {
    const auto streamed =
        open_streamed(test::source_of(bytes), desc, *backend, StreamRig::memory(), workers);
    View view(streamed, *backend, {}, StreamRig::memory(), workers);
    FrameInput input = from({0, -2, -12}, 1);
    render(view, input);
    while (streamed->stream->step()) continue;
    input.wait_resident = true;
    render(view, input);
  };
  const ErrorCode code = test::error_code(open_and_draw);
  EXPECT_TRUE(code == ErrorCode::damaged_chunk || code == ErrorCode::over_budget);
}

// More children than a shape has room to say, in one chunk and in several.
TEST(StreamingRecords, LargeFamiliesComeAndGo) {
  for (const test::TreeShape shape : {test::TreeShape::star, test::TreeShape::star_of_stars}) {
    SCOPED_TRACE(test::name_of(shape));
    StreamRig rig(test::baked_of(test::random_tree(shape, 30000, 6)), 1.0, {}, kMinChunkBytes,
                  Quality::compact);
    ASSERT_FALSE(rig.resident->large_families.empty());
    size_t blended = 0;
    std::mt19937 random(4);
    for (int i = 0; i < 20; ++i) {
      const Vec3d eye{200.0 * test::unit(random) - 100, -6, 200.0 * test::unit(random) - 100};
      FrameInput input = from(eye, 2.0 * (i + 1));
      input.wait_resident = true;
      expect_same_bits(render(rig.part, input), render(rig.whole, input));
      blended += rig.streamed->large_families.size();
      if (i % 5 == 4) rig.streamed->stream->set_budget(0, rig.workers);
    }
    EXPECT_GT(blended, 0u);
  }
}

}  // namespace
}  // namespace voyager::streaming_records_test
