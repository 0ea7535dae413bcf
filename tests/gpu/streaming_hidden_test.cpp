// What a device tells of the chunks that it shows: what is hidden is read last of what is seen, and
// no picture knows of it.
#include "tests/gpu/splat_test.h"
#include "tests/support/wall_scene.h"

namespace voyager::test {
namespace streaming_hidden_test {
namespace {

constexpr int kTellEvery = 16;  // frames, of which one tells

class StreamingHidden : public SplatTest {
 protected:
  static std::vector<NamedDesc> descs() {
    return {{"exact", {}},
            {"ex2", {.exponential = Exponential::ex2}},
            {"half2", {.exponential = Exponential::half2}},
            {"lut without a filter", {.alpha_filter = false, .exponential = Exponential::lut}}};
  }
  Frame whole(const PipelineDesc& desc, const FrameInput& input) {
    return draw(load_scene(source_of(wall_bytes()), std::pmr::get_default_resource(), workers),
                desc, input);
  }
};

TEST_F(StreamingHidden, WhatIsBehindAWallIsAskedForLast) {
  for (const NamedDesc& named : descs()) {
    SCOPED_TRACE(named.name);
    StreamedWall with(*cuda, true, named.desc), without(*cuda, false, named.desc);
    const Frame frame = with.settle(before_the_wall(), kTellEvery);
    expect_same_bits(without.settle(before_the_wall(), kTellEvery), frame);
    expect_same_bits(whole(named.desc, before_the_wall()), frame);
    EXPECT_GT(with.behind_later(), without.behind_later() + 0.15);
  }
}

// Of frames that nothing comes between, some tell and some do not.
TEST_F(StreamingHidden, AFrameThatTellsIsTheSame) {
  for (const NamedDesc& named : descs()) {
    SCOPED_TRACE(named.name);
    StreamedWall wall(*cuda, true, named.desc);
    wall.begin(before_the_wall(), 6);
    ASSERT_TRUE(wall.stream().wants_shown());
    const Frame first = wall.draw(before_the_wall());
    for (int i = 0; i < 2 * kTellEvery; ++i) expect_same_bits(wall.draw(before_the_wall()), first);
  }
}

// A view's first frame has too little room for so many instances, and tells all the same. Whether
// it reads and marks only what is there is for compute-sanitizer to see.
TEST_F(StreamingHidden, AFrameWithoutRoomTellsOfWhatItDraws) {
  StreamedWall whole(*cuda, true), part(*cuda, true);
  whole.settle(before_the_wall());
  part.begin(before_the_wall(), 6);
  Scenes scenes(50, whole.scene());
  scenes.push_back(part.scene());
  View many(scenes, *cuda, {}, std::pmr::get_default_resource(), workers);
  FrameInput input = before_the_wall();
  input.instances.resize(scenes.size());
  ASSERT_TRUE(part.stream().wants_shown());
  const Frame first = render(many, input);
  EXPECT_GT(first.stats.redraws, 0u);
  EXPECT_GT(first.stats.cut_size, 1u << 18);
  expect_same_bits(render(many, input), first);
}

// With room for a part, and from the other side: stale marks and pools that change their size.
TEST_F(StreamingHidden, WhoeverHasMovedSeesAndWaitsForTheSame) {
  StreamedWall with(*cuda, true, {}, 0.4), without(*cuda, false, {}, 0.4);
  for (StreamedWall* one : {&with, &without}) one->begin(before_the_wall(), 8);
  const Frame frame = with.settle(behind_the_wall());
  EXPECT_EQ(without.settle(behind_the_wall()).cut, frame.cut);
  EXPECT_EQ(without.stream().counters().resident, with.stream().counters().resident);
  StreamedWall waits(*cuda, true);
  waits.begin(before_the_wall(), 8);
  FrameInput input = behind_the_wall();
  input.wait_resident = true;
  expect_same_bits(waits.draw(input), whole({}, input));
}

}  // namespace
}  // namespace streaming_hidden_test
}  // namespace voyager::test
