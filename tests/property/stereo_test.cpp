// Two eyes of one view: each sees what it would see alone, by one cut that is fine enough for both.
#include "tests/support/stereo.h"
#include "runtime/frame/frame_search.h"
#include "runtime/frame/whole_tree.h"
#include "tests/support/depth_limits.h"

namespace voyager::stereo_test {
namespace {

using test::EyeFrames;
using test::Frame;
using test::look;
using test::one_eye;
using test::render_stereo;
using test::stereo_input;

std::vector<std::unique_ptr<Backend>> backends() {
  std::vector<std::unique_ptr<Backend>> all;
  all.push_back(create_cpu_backend());
  all.push_back(create_reference_backend());
  return all;
}

void expect_as_alone(Backend& backend, const std::shared_ptr<const Scene>& scene,
                     const PipelineDesc& desc, const FrameInput& pair) {
  const EyeFrames found = render_stereo(backend, scene, desc, pair);
  uint64_t splats = 0, pairs = 0;
  for (size_t eye = 0; eye < 2; ++eye) {
    SCOPED_TRACE(eye == 0 ? "left" : "right");
    const Frame alone = test::render(backend, scene, desc, one_eye(pair, eye));
    test::expect_same_bits(found[eye], alone);
    EXPECT_EQ(found[eye].cut, alone.cut);
    splats += alone.stats.splats, pairs += alone.stats.pairs_after;
  }
  EXPECT_GT(splats, 0u);
  EXPECT_EQ(found[0].stats.splats, splats);
  EXPECT_EQ(found[0].stats.pairs_after, pairs);
}

// A flat scene has no cut that the other eye could change.
TEST(Stereo, EyesOfAFlatSceneAreToTheBitAsAlone) {
  const auto scene = test::flat_scene(test::random_cloud(1500, 21, 3));
  for (const auto& backend : backends())
    for (const FrameInput& pair : test::varied_pairs())
      for (const bool filter : {true, false})
        expect_as_alone(*backend, scene, {.alpha_filter = filter}, pair);
}

// Eyes in one place have one eye's cut, whatever they look at; nodes between their parents and
// themselves are among it.
TEST(Stereo, EyesInOnePlaceAreToTheBitAsAloneWithATree) {
  const auto scene = test::baked_scene(test::random_cloud(1500, 22, 2));
  Camera ahead = look({3, -6, -24}, {0, 0, 0}, 133, 77),
         aside = look({3, -6, -24}, {4, 1, 3}, 60, 90);
  aside.fx = ahead.fx;
  for (const auto& backend : backends())
    for (const double tau : {0.0, 3.0, 12.0, 40.0})
      expect_as_alone(*backend, scene, {}, stereo_input(ahead, aside, tau));
}

TEST(Stereo, TheCutIsThatOfThePointAmidTheEyesAtTheSmallestTauStar) {
  const auto scene = test::baked_scene(test::random_cloud(2000, 23, 1));
  const auto backend = create_cpu_backend();
  Workers workers;
  for (const FrameInput& pair : test::varied_pairs()) {
    const Camera &left = pair.eyes[0].camera, &right = pair.eyes[1].camera;
    const CutQuery expected{cut_centre(0.5 * (left.eye + right.eye), scene->origin),
                            target_size(pair.tau, std::max(left.fx, right.fx))};
    ExhaustiveSearch search;
    search.run(*whole_tree(*scene), {}, expected, workers);
    const EyeFrames found = render_stereo(*backend, scene, {}, pair);
    EXPECT_TRUE(std::equal(search.cut().begin(), search.cut().end(), found[0].cut.begin(),
                           found[0].cut.end()));
    EXPECT_EQ(found[0].stats.tau_star, expected.target_size);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(found[0].stats.cut_centre[i], expected.centre[i]);
  }
}

TEST(Stereo, WhichEyeComesFirstDoesNotMatter) {
  const auto scene = test::baked_scene(test::random_cloud(1500, 24, 2));
  const auto backend = create_cpu_backend();
  for (const FrameInput& pair : test::varied_pairs()) {
    const EyeFrames found = render_stereo(*backend, scene, {}, pair);
    const EyeFrames swapped = render_stereo(
        *backend, scene, {}, stereo_input(pair.eyes[1].camera, pair.eyes[0].camera, pair.tau));
    test::expect_same_bits(found[0], swapped[1]);
    test::expect_same_bits(found[1], swapped[0]);
    EXPECT_EQ(found[0].cut, swapped[0].cut);
  }
}

TEST(Stereo, TheCpuIsAsNearTheReferenceAsWithOneEye) {
  const auto scene = test::baked_scene(test::random_cloud(1500, 25, 3));
  const auto cpu = create_cpu_backend();
  const auto reference = create_reference_backend();
  for (const FrameInput& pair : test::varied_pairs()) {
    const EyeFrames found = render_stereo(*cpu, scene, {}, pair);
    const EyeFrames expected = render_stereo(*reference, scene, {}, pair);
    for (size_t eye = 0; eye < 2; ++eye) {
      EXPECT_EQ(found[eye].cut, expected[eye].cut);
      EXPECT_GE(test::compare(found[eye], expected[eye]).psnr, 60) << eye;
    }
  }
}

// Depth and limits are an eye's own: what one has, the other need not.
TEST(Stereo, DepthAndLimitsAreAnEyesOwn) {
  const auto scene = test::flat_scene(test::random_cloud(1500, 26, 1));
  for (const auto& backend : backends())
    for (FrameInput pair : test::varied_pairs()) {
      const test::LimitImage limits(pair.eyes[1].camera, 15);
      pair.eyes[0].depth_wanted = false;
      pair.eyes[1].limits = limits.limits();
      expect_as_alone(*backend, scene, {}, pair);
    }
}

// A walk: what a view keeps from frame to frame are the pair's cuts.
TEST(Stereo, AWalkIsAsItsFramesByViewsOfTheirOwn) {
  const auto scene = test::baked_scene(test::random_cloud(2000, 27, 1));
  const auto backend = create_cpu_backend();
  Workers workers;
  PipelineDesc desc;
  desc.eyes = 2;
  View view(scene, *backend, desc, std::pmr::get_default_resource(), workers);
  for (int i = 0; i < 12; ++i) {
    const double x = 0.4 * i;
    const FrameInput pair =
        test::headset_pair({x, -2, -20}, {x + 0.065, -2, -20 + 0.01 * i}, {0.02 * i, 0, 1}, 4);
    const EyeFrames walked = render_stereo(view, pair);
    const EyeFrames fresh = render_stereo(*backend, scene, {}, pair);
    for (size_t eye = 0; eye < 2; ++eye) test::expect_same_bits(walked[eye], fresh[eye]);
    EXPECT_EQ(walked[0].cut, fresh[0].cut);
  }
}

}  // namespace
}  // namespace voyager::stereo_test
