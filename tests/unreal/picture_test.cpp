// The picture in Unreal's texture, and what is in its depth buffer then.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/unreal/unreal_rig.h"

namespace voyager::test {
namespace unreal_picture_test {
namespace {

TEST_F(UnrealModule, PicturesAreWhatVoyagerRenders) {
  ImitatedUnreal unreal;
  VOYAGER_NEEDS_VULKAN(unreal);
  ASSERT_TRUE(open(unreal)) << unreal.last_error();
  Textures textures(unreal);
  for (const double right : {100.0, -300.0}) {
    UnrealCamera at = camera();
    at.position.Y = origin().Y + right;
    const Picture expected = reference(at);
    EXPECT_LE(largest_difference(shoot(unreal, textures, at), expected), 1) << right;
    EXPECT_GT(*std::max_element(expected.values.begin(), expected.values.end()), 100);
  }
  EXPECT_EQ(unreal.last_error(), "");
}

TEST_F(UnrealModule, ASceneIsReplacedAndTheTexturesChange) {
  ImitatedUnreal unreal;
  VOYAGER_NEEDS_VULKAN(unreal);
  write_bytes(file("other.ply"), ply_bytes(50));
  ASSERT_TRUE(open(unreal, "other.ply")) << unreal.last_error();
  Textures first(unreal, VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_D16_UNORM);
  shoot(unreal, first, camera());
  ASSERT_TRUE(open(unreal)) << unreal.last_error();
  Textures second(unreal);
  EXPECT_LE(largest_difference(shoot(unreal, second, camera()), reference(camera())), 1);
  unreal.module().CloseScene();
  const Picture closed = shoot(unreal, second, camera());
  EXPECT_TRUE(
      std::all_of(closed.values.begin(), closed.values.end(), [](float v) { return v == 0; }));
  EXPECT_EQ(unreal.last_error(), "");
}

// As the last pass after tonemapping, whose output is the engine's back buffer.
TEST_F(UnrealModule, TheLastPassDrawsIntoTheOutput) {
  ImitatedUnreal unreal;
  VOYAGER_NEEDS_VULKAN(unreal);
  ASSERT_TRUE(open(unreal)) << unreal.last_error();
  Textures textures(unreal), output(unreal);
  UnrealView view = view_of(textures, camera());
  view.override_output = &output.colour_in_graph;
  for (int i = 0; i < 5; ++i) unreal.frame(view);
  EXPECT_LE(largest_difference(picture_of(unreal.read(*output.colour)), reference(camera())), 1);
  const Picture input = picture_of(unreal.read(*textures.colour));
  EXPECT_TRUE(
      std::all_of(input.values.begin(), input.values.end(), [](float v) { return v == 0; }));
  EXPECT_EQ(unreal.last_error(), "");
}

// A depth buffer that holds one plane.
TEST_F(UnrealModule, MeshesHideSplatsAndSplatsWriteTheirDepth) {
  ImitatedUnreal unreal;
  VOYAGER_NEEDS_VULKAN(unreal);
  ASSERT_TRUE(open(unreal)) << unreal.last_error();
  const Picture whole = reference(camera());
  const Picture metres = read_pfm(file("depth.pfm"));
  constexpr float kPlane = 12;
  const float cleared = camera().depth_at(static_cast<double>(kPlane));
  Textures textures(unreal);
  const Picture drawn = shoot(unreal, textures, camera(), cleared);
  const std::vector<uint8_t> bytes = unreal.read(*textures.depth);
  size_t shown = 0, hidden = 0;
  for (size_t i = 0; i < metres.values.size(); ++i) {
    if (std::abs(metres.values[i] - kPlane) < 0.01f) continue;
    const bool before = metres.values[i] < kPlane;
    ++(before ? shown : hidden);
    for (size_t c = 3 * i; c < 3 * i + 3; ++c)
      EXPECT_NEAR(drawn.values[c], before ? whole.values[c] : 0, 1) << i;
    float depth = 0;
    const size_t x = i % kWidth + kLeft, y = i / kWidth + kTop;
    std::memcpy(&depth, bytes.data() + 4 * (y * kTextureWidth + x), sizeof depth);
    const float expected =
        before ? camera().depth_at(static_cast<double>(metres.values[i])) : cleared;
    EXPECT_NEAR(depth, expected, 1e-6f) << i;
  }
  EXPECT_GT(shown, 100u);
  EXPECT_GT(hidden, 100u);
  EXPECT_EQ(unreal.last_error(), "");
}

}  // namespace
}  // namespace unreal_picture_test
}  // namespace voyager::test
