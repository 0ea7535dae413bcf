// Streaming on a made-up city, and on the captured district: frames that wait are those of the
// scene loaded whole, and the first one that does not wait is close to it.
#include "runtime/frame/whole_tree.h"
#include "runtime/scene/append.h"
#include "tests/support/real_scenes.h"
#include "tests/support/stream_rig.h"
#include "tests/support/tree_rules.h"
#include "tools/synth/city.h"

namespace voyager::streaming_scenes_test {
namespace {

using test::Frame;
using test::StreamRig;

GaussianCloud made_up_city(uint64_t gaussians) {
  GaussianCloud city;
  synth::generate_city({gaussians, 1, 1}, [&](const GaussianCloud& part) {
    GaussianCloud copy = part;
    if (city.size() == 0)
      city = std::move(copy);
    else
      append(city, std::move(copy), "city");
  });
  return city;
}

// Down a street, and a turn at its end.
std::vector<FrameInput> street(double tau) {
  std::vector<FrameInput> frames;
  for (int i = 0; i < 12; ++i) {
    const Vec3d eye{0, -1.7, -22 + 2.0 * i};
    const double turn = i < 8 ? 0 : 0.5 * (i - 7);
    frames.push_back(test::frame_input(
        test::look(eye, eye + Vec3d{std::sin(turn), 0.06, std::cos(turn)}, 160, 90, 70), tau));
  }
  return frames;
}

void expect_resident_frames(StreamRig& rig, const std::vector<FrameInput>& path) {
  for (FrameInput input : path) {
    const Frame whole = test::render(rig.whole, input);
    const Frame coarse = test::render(rig.part, input);
    ASSERT_TRUE(test::is_cut(*whole_tree(*rig.resident), coarse.cut));
    input.wait_resident = true;
    const Frame part = test::render(rig.part, input);
    ASSERT_EQ(part.cut, whole.cut);
    test::expect_same_bits(part, whole);
  }
}

TEST(StreamingScenes, TheCityFromAStreet) {
  const BakedScene baked =
      test::bake(made_up_city(test::whole_paths() ? 60000 : 20000), test::city_rule());
  for (const double tau : {0.0, 3.0, 15.0})
    for (const Search search : {Search::temporal, Search::streaming}) {
      PipelineDesc desc;
      desc.search = search;
      StreamRig rig(baked, 1.0, desc, kDefaultChunkBytes, Quality::compact);
      expect_resident_frames(rig, street(tau));
    }
}

TEST(StreamingScenes, TheDistrictFromAbove) {
  VOYAGER_NEEDS_SCENES(folder);
  StreamRig rig(test::bake(test::district(folder), test::city_rule()), 1.0, {}, kDefaultChunkBytes,
                Quality::compact);
  const test::Middle middle = test::middle_of(*rig.resident);
  std::vector<FrameInput> path;
  for (const double turn : {0.0, 0.1, 2.0, 4.0}) {
    const Vec3d eye =
        middle.centre + (0.4 * middle.reach) * Vec3d{std::cos(turn), -0.5, std::sin(turn)};
    path.push_back(test::frame_input(test::look(eye, middle.centre, 240, 160, 60), 3));
  }
  expect_resident_frames(rig, path);
}

// 1 - T of the scene's first frame that does not wait, against the whole scene's.
double share_within_a_tenth(StreamRig& rig, const FrameInput& input, uint64_t first_bytes) {
  const Frame whole = test::render(rig.whole, input);
  const auto scene =
      rig.open(test::source_of(rig.bytes), 1.0, first_bytes, input.eyes[0].camera.eye);
  View view(scene, *rig.backend, {}, rig.memory(), rig.workers);
  const Frame first = test::render(view, input);
  EXPECT_TRUE(test::is_cut(*whole_tree(*rig.resident), first.cut));
  size_t within = 0;
  for (size_t i = 3; i < whole.rgba.size(); i += 4)
    within += std::fabs(whole.rgba[i] - first.rgba[i]) <= 0.1f;
  return static_cast<double>(within) / static_cast<double>(whole.rgba.size() / 4);
}

TEST(StreamingScenes, TheFirstFrameIsNearlyAsDense) {
  StreamRig rig(test::bake(made_up_city(test::whole_paths() ? 200000 : 40000)), 1.0, {},
                kDefaultChunkBytes, Quality::compact);
  for (const FrameInput& input : street(3)) {
    EXPECT_GE(share_within_a_tenth(rig, input, rig.bytes.size() / 3), 0.9);
    EXPECT_GE(share_within_a_tenth(rig, input, rig.bytes.size() * 2 / 3), 0.96);
  }
}

}  // namespace
}  // namespace voyager::streaming_scenes_test
