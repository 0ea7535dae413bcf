// Rows of a cut's list that no Gaussian of reaches the image are left out before they are read.
#include <array>

#include "tests/gpu/splat_test.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"
#include "tests/support/stereo.h"

namespace voyager::test {
namespace splat_rows_test {
namespace {

class SplatRows : public SplatTest {
 protected:
  // In place, then on the way through the cloud, then back at once: cuts of which all, some or
  // nothing is written anew.
  static std::vector<Camera> way() {
    std::vector<Camera> cameras;
    for (int i = 0; i < 6; ++i) {
      const double turn = i;
      cameras.push_back(look({1, 1, 1}, {1 + std::sin(turn), 1.2, 1 + std::cos(turn)}, 240, 150));
    }
    for (int i = 0; i < 6; ++i)
      cameras.push_back(look({2.0 * i, -6, -24 + 6.0 * i}, {0.1, 0.2, 5}, 240, 150));
    cameras.push_back(cameras.front());
    return cameras;
  }
};

TEST_F(SplatRows, NoPixelMissesThem) {
  const auto scene = baked_scene(random_cloud(share_of(60000), 95, 1));
  for (const Search search : {Search::temporal, Search::streaming})
    for (const double tau : {0.0, 3.0, 12.0}) {
      const auto kept = view(scene, {.search = search});
      for (const Camera& camera : way()) {
        const FrameInput input = frame_input(camera, tau);
        expect_same_bits(render(*kept, input), draw(scene, {.search = Search::exhaustive}, input));
      }
    }
}

// Of few nodes to a level, so that a row has those of several (SearchTest's
// EqualTheHostsWhereAListHasNoRoomForRows).
TEST_F(SplatRows, NoPixelMissesThoseThatLevelsShare) {
  for (LodTree& tree :
       std::array{random_tree(TreeShape::uneven, 3000, 9), tree_of_chains(2000, 30, 9)}) {
    const auto scene = loaded(baked_of(std::move(tree)));
    for (const double tau : {0.0, 3.0}) {
      const auto kept = view(scene, {.search = Search::temporal});
      for (const Camera& camera : way()) {
        const FrameInput input = frame_input(camera, tau);
        expect_same_bits(render(*kept, input), draw(scene, {.search = Search::exhaustive}, input));
      }
    }
  }
}

TEST_F(SplatRows, NoPixelOfEitherEyeMissesThem) {
  const auto scene = baked_scene(random_cloud(share_of(60000), 96, 1), Quality::compact);
  const auto kept = view(scene, {.search = Search::temporal, .eyes = 2});
  for (const Camera& camera : way()) {
    // Eyes that look apart: what one does not see the other may.
    const FrameInput pair = stereo_input(camera, look(camera.eye, {5, 2, 9}, 240, 150), 3);
    const EyeFrames found = render_stereo(*kept, pair);
    for (size_t eye = 0; eye < 2; ++eye)
      expect_same_bits(found[eye], draw(scene, {.search = Search::exhaustive}, one_eye(pair, eye)));
  }
}

TEST_F(SplatRows, WhatIsNotSeenIsNotRead) {
  const auto scene = baked_scene(random_cloud(share_of(60000), 97, 1));
  const auto bytes = [&](Search search, const Vec3d& target) {
    const auto drawn = view(scene, {.search = search});
    return render(*drawn, frame_input(look({0, 0, -40}, target, 240, 150), 0))
        .stats.bytes[kProject];
  };
  // Away from all of it, where only the bounds are read: a byte of each place.
  EXPECT_LT(bytes(Search::temporal, {0, 0, -80}), bytes(Search::exhaustive, {0, 0, -80}) / 10);
  EXPECT_LT(bytes(Search::temporal, {0, 0, 0}), bytes(Search::exhaustive, {0, 0, 0}) * 11 / 10);
}

}  // namespace
}  // namespace splat_rows_test
}  // namespace voyager::test
