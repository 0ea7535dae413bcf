// A frame that waits for two scenes, one after the other: what the first one had may have gone by
// the time when both are held.
#include "runtime/base/error.h"
#include "tests/support/random_trees.h"
#include "tests/support/stream_rig.h"

namespace voyager::streaming_waits_test {
namespace {

using test::expect_same_bits;
using test::frame_input;
using test::look;
using test::render;
using test::StreamRig;

const test::Bytes& scene() {
  static const test::Bytes bytes = test::scene_bytes(test::bake(test::random_cloud(4000, 12, 1)),
                                                     Quality::compact, 0, kMinChunkBytes);
  return bytes;
}

class StreamingWaits : public testing::Test {
 protected:
  StreamingWaits() {
    for (size_t i = 0; i < 2; ++i) {
      StreamingDesc desc;
      desc.readers = 0;
      desc.clock = [this, i] {
        if (scenes[i].get() == second && at_second) at_second();
        return time += 1e-5;
      };
      scenes.push_back(open_streamed(test::source_of(rig.bytes), desc, *rig.backend,
                                     StreamRig::memory(), rig.workers));
    }
    // Frames wait in the order of the addresses.
    first = scenes[0].get() < scenes[1].get() ? scenes[0].get() : scenes[1].get();
    second = scenes[0].get() < scenes[1].get() ? scenes[1].get() : scenes[0].get();
    part = std::make_unique<View>(scenes, *rig.backend, PipelineDesc{}, StreamRig::memory(),
                                  rig.workers);
    input.wait_resident = true;
    SceneStream& stream = *first->stream;
    const uint32_t top = SceneStream::top_chunks(stream.file());
    PoolRoom room = RecordRoom(stream.file()).of(stream.counters().slots);
    stream.resize(room, top, rig.workers);
    render(*part, input);
    another_looks();  // what a family of nodes needs is counted by the next plan
    render(*part, input);
    room.slots = top + static_cast<uint32_t>(stream.counters().need.seen);
    stream.resize(room, top, rig.workers);
  }

  // Somebody looks at the first scene from elsewhere until all of that is there, and goes.
  void another_looks() {
    SceneStream& stream = *first->stream;
    const char other = 0;
    const Vec3f eye{18, -6, 18};
    stream.look(&other, {{{eye, 0.01f}, {Wedge{eye, {}}}, false}});
    for (int i = 0; i < 10; ++i) {
      while (stream.step()) continue;
      stream.commit();
    }
    stream.look(&other, {});
  }

  StreamRig rig{scene(), 1.0};
  double time = 0;
  std::function<void()> at_second;  // whenever the second scene is waited for
  Scenes scenes;
  const Scene *first = nullptr, *second = nullptr;
  std::unique_ptr<View> part;
  FrameInput input = frame_input(look({-18, -6, -18}, {0, 0, 0}, 24, 18, 60), 1);
};

TEST_F(StreamingWaits, WhatWentIsWaitedForAgain) {
  View whole({rig.resident, rig.resident}, *rig.backend, {}, StreamRig::memory(), rig.workers);
  const test::Frame expected = render(whole, input);
  expect_same_bits(render(*part, input), expected);
  bool done = false;
  at_second = [&] {
    if (!std::exchange(done, true)) another_looks();
  };
  const uint64_t evicted = first->stream->counters().chunks.evicted;
  expect_same_bits(render(*part, input), expected);
  EXPECT_TRUE(done);
  EXPECT_GT(first->stream->counters().chunks.evicted, evicted);
}

TEST_F(StreamingWaits, WhatGoesEachTimeIsTold) {
  at_second = [&] { another_looks(); };
  try {
    render(*part, input);
    FAIL() << "expected a refusal";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::over_budget);
    EXPECT_NE(std::string(error.what()).find("64 times"), std::string::npos) << error.what();
  }
  at_second = {};
  EXPECT_NO_THROW(render(*part, input));
}

}  // namespace
}  // namespace voyager::streaming_waits_test
