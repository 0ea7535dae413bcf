// What the frame before shows to be hidden is left out, and no bit of a picture tells.
#include "runtime/stages/bin.h"
#include "tests/gpu/splat_test.h"
#include "tests/support/depth_limits.h"
#include "tests/support/instances.h"
#include "tests/support/stereo.h"

namespace voyager::test {
namespace splat_occlusion_test {
namespace {

PipelineDesc with(Occlusion occlusion, PipelineDesc desc = {}) {
  desc.occlusion = occlusion;
  return desc;
}

// Steps of a walk, turns of a head, a zoom, jumps from one side of the cloud to the other, and
// frames in place.
std::vector<Camera> way() {
  std::vector<Camera> all;
  const auto add = [&](const Vec3d& eye, const Vec3d& at, double fov = 60) {
    all.push_back(look(eye, at, 300, 200, fov));
  };
  for (int i = 0; i < 6; ++i) add({0.05 * i, 0, -24 + 0.1 * i}, {0, 0, 0});
  for (int i = 0; i < 6; ++i) add({0.3, 0, -23.4}, {3.0 * i, 0.4 * i, 0});
  for (int i = 0; i < 4; ++i) add({0.3, 0, -23.4}, {15, 2, 0}, 60 - 12.0 * i);
  for (int i = 0; i < 4; ++i) add({1 + 0.02 * i, 1, 1}, {5, 2, 9});
  add({0, -20, 20}, {0, 0, 0});
  add({0, 0, -40}, {0, 0, -80});
  add({0, 0, -24}, {0, 0, 0});
  add({0, 0, -24}, {0, 0, 0});
  return all;
}

class SplatOcclusion : public SplatTest {};

TEST_F(SplatOcclusion, NoPixelMissesWhatWasLeftOut) {
  const GaussianCloud cloud = random_cloud(share_of(60000), 31, 1);
  for (const std::shared_ptr<const Scene>& scene :
       std::vector<std::shared_ptr<const Scene>>{baked_scene(cloud), flat_scene(cloud)})
    for (const NamedDesc& named : all_exponentials(std::array{32u})) {
      SCOPED_TRACE(named.name);
      const auto on = view(scene, with(Occlusion::on, named.desc));
      const auto off = view(scene, with(Occlusion::off, named.desc));
      for (const Camera& camera : way()) {
        FrameInput input = frame_input(camera, 3);
        input.eyes[0].depth_wanted = camera.eye.z > 0;
        expect_same_bits(render(*on, input), render(*off, input));
      }
    }
}

TEST_F(SplatOcclusion, NoPixelOfEitherEyeMissesIt) {
  const auto scene = baked_scene(random_cloud(share_of(60000), 32, 1), Quality::compact);
  const auto on = view(scene, {.search = Search::temporal, .occlusion = Occlusion::on, .eyes = 2});
  const auto off = view(scene, {.occlusion = Occlusion::off, .eyes = 2});
  for (const Camera& camera : way()) {
    Camera right = camera;
    right.eye = right.eye + 0.3 * right.world_to_view.row[0];
    const FrameInput pair = stereo_input(camera, right, 3);
    const EyeFrames found = render_stereo(*on, pair), expected = render_stereo(*off, pair);
    for (size_t eye = 0; eye < 2; ++eye) expect_same_bits(found[eye], expected[eye]);
  }
}

// What covers the rest may go between two frames: as an instance, or as the engine's depth.
TEST_F(SplatOcclusion, WhatIsUncoveredIsDrawnAtOnce) {
  GaussianCloud wall = random_cloud(share_of(20000), 33, 0, 2.0f);
  for (float& logit : wall.opacity) logit = 5;
  const Scenes scenes{baked_scene(random_cloud(share_of(30000), 34, 1)), baked_scene(wall)};
  const auto made = [&](Occlusion occlusion) {
    return std::make_unique<View>(scenes, *cuda, with(occlusion), std::pmr::get_default_resource(),
                                  workers);
  };
  const auto on = made(Occlusion::on), off = made(Occlusion::off);
  const Camera camera = look({0, 0, -24}, {0, 0, 0}, 300, 200);
  const LimitImage near(camera, 6.0f);
  for (int i = 0; i < 8; ++i) {
    FrameInput input = frame_input(camera, 3);
    input.instances = {pose_of({0, 0, 0}), pose_of({i < 4 ? 0.0 : 30.0, 0, -18}, 5.0 * i, 2)};
    if (i == 2 || i == 6) input = limited(input, near);
    expect_same_bits(render(*on, input), render(*off, input));
  }
}

// In the whole image, where a view that has seen nothing but what hides it has too little room; and
// beside an edge that moves by a few pixels, so that long lists of few tiles are drawn once more.
TEST_F(SplatOcclusion, WhatIsUncoveredMayBeMoreThanThereIsRoomFor) {
  const auto sheets = empty_scene();
  for (int i = 0; i < 4000; ++i)
    add_gaussian(*sheets, {0, 0, 1 + 1e-4f * static_cast<float>(i)}, {1e4f, 1e4f, 1e-6f}, 0.004f);
  const Vec3d behind{0, 0, -50}, ahead{0, 0, 0};
  for (const auto& [width, aside] : {std::pair{1e4f, 1e6}, std::pair{0.3f, 0.06}}) {
    SCOPED_TRACE(width);
    const auto wall = empty_scene();
    for (int i = 0; i < 12; ++i)
      add_gaussian(*wall, {0, 0, 0.5f + 1e-3f * static_cast<float>(i)}, {width, 1e4f, 1e-6f}, 0.99f,
                   {1, 0, 0});
    const auto made = [&](Occlusion occlusion) {
      return std::make_unique<View>(Scenes{sheets, wall}, *cuda, with(occlusion),
                                    std::pmr::get_default_resource(), workers);
    };
    const auto on = made(Occlusion::on), off = made(Occlusion::off);
    for (const auto& [of_sheets, of_wall] : {std::pair{behind, ahead},
                                             {behind, ahead},
                                             {ahead, ahead},
                                             {ahead, Vec3d{aside, 0, 0}},
                                             {ahead, Vec3d{aside, 0, 0}}}) {
      FrameInput input = frame_input(look({0, 0, 0}, {0, 0, 1}, 333, 320));
      input.instances = {pose_of(of_sheets), pose_of(of_wall)};
      expect_same_bits(render(*on, input), render(*off, input));
    }
  }
}

// A second pass has lists of its own for few tiles: to either side of the most that these may be.
TEST_F(SplatOcclusion, AnyNumberOfTilesIsDrawnOnceMore) {
  const auto sheets = empty_scene(), wall = empty_scene();
  for (int i = 0; i < 400; ++i)
    add_gaussian(*sheets, {0, 0, 1 + 1e-3f * static_cast<float>(i)}, {1e4f, 1e4f, 1e-6f}, 0.04f);
  for (int i = 0; i < 12; ++i)
    add_gaussian(*wall, {0, 0, 0.5f + 1e-3f * static_cast<float>(i)}, {1e4f, 1e4f, 1e-6f}, 0.99f,
                 {1, 0, 0});
  const Vec3d ahead{0, 0, 0}, gone{1e6, 0, 0};
  for (const int tiles : {1, 31, 32, 33, 100}) {
    SCOPED_TRACE(tiles);
    const auto made = [&](Occlusion occlusion) {
      return std::make_unique<View>(Scenes{sheets, wall}, *cuda, with(occlusion),
                                    std::pmr::get_default_resource(), workers);
    };
    const auto on = made(Occlusion::on), off = made(Occlusion::off);
    const Camera column = look({0, 0, 0}, {0, 0, 1}, kTile, tiles * kTile, 2);
    for (const int frame : {0, 1, 2, 3}) {
      FrameInput input = frame_input(column);
      input.instances = {pose_of(ahead), pose_of(frame < 2 ? ahead : gone)};
      const Frame found = render(*on, input);
      expect_same_bits(found, render(*off, input));
      EXPECT_EQ(found.stats.tiles_redrawn, frame == 2 ? static_cast<uint64_t>(tiles) : 0);
    }
  }
}

TEST_F(SplatOcclusion, WhatIsHiddenIsNotDrawn) {
  const auto scene = baked_scene(random_cloud(share_of(200000), 35, 1));
  const FrameInput input = frame_input(look({0, 0, -24}, {0, 0, 0}, 640, 400), 1);
  const auto stats = [&](Occlusion occlusion, Search search) {
    const auto drawn = view(scene, {.search = search, .occlusion = occlusion});
    render(*drawn, input);
    return render(*drawn, input).stats;
  };
  for (const Search search : {Search::temporal, Search::exhaustive}) {
    const FrameStats on = stats(Occlusion::on, search), off = stats(Occlusion::off, search);
    EXPECT_LT(on.pairs_after, off.pairs_after / 2);
    EXPECT_LT(on.splats, off.splats / 2);
    EXPECT_LT(on.bytes[kProject], off.bytes[kProject]);
  }
}

// By itself where that is less work, and not in a picture that nothing covers.
TEST_F(SplatOcclusion, IsChosenWhereItPays) {
  GaussianCloud sparse = random_cloud(share_of(400000), 36, 0);
  for (float& logit : sparse.opacity) logit = -4.5f;
  for (float& log : sparse.log_scale) log -= 1.5f;
  const auto pairs = [&](const GaussianCloud& cloud, Occlusion occlusion) {
    const auto drawn = view(flat_scene(cloud), with(occlusion));
    std::vector<uint64_t> all;
    for (int i = 0; i < 4; ++i)
      all.push_back(
          render(*drawn, frame_input(look({0, 0, -24}, {0, 0, 0}, 1280, 800))).stats.pairs_after);
    return all;
  };
  const GaussianCloud dense = random_cloud(share_of(400000), 37, 0);
  const auto of_dense = pairs(dense, Occlusion::automatic);
  ASSERT_GT(of_dense[0], uint64_t{1} << 19);
  EXPECT_EQ(of_dense[0], pairs(dense, Occlusion::off)[0]);
  for (size_t i = 1; i < of_dense.size(); ++i) EXPECT_LT(of_dense[i], of_dense[0] / 2);
  const auto of_sparse = pairs(sparse, Occlusion::automatic);
  ASSERT_GT(of_sparse[0], uint64_t{1} << 19);
  EXPECT_EQ(of_sparse[3], of_sparse[0]);
}

}  // namespace
}  // namespace splat_occlusion_test
}  // namespace voyager::test
