// Where the module cannot draw, it says why, and Unreal goes on.
#include <algorithm>

#include "tests/unreal/unreal_rig.h"

namespace voyager::test {
namespace unreal_refusal_test {
namespace {

using UnrealRefusals = UnrealModule;

TEST_F(UnrealRefusals, ExtensionsAreAskedForBeforeThereIsADevice) {
  ImitatedUnreal unreal;
  const auto asked = [&](const char* name) {
    return std::count(unreal.requested().begin(), unreal.requested().end(), name);
  };
  EXPECT_EQ(asked(VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME), 1);
  EXPECT_EQ(asked(VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME), 1);
}

// Frames are then copied from memory that Vulkan maps.
TEST_F(UnrealRefusals, ADriverWithoutExtensionsDrawsTheSamePicture) {
  UnrealHabits habits;
  habits.enables_requested = false;
  ImitatedUnreal unreal(habits);
  VOYAGER_NEEDS_VULKAN(unreal);
  ASSERT_TRUE(open(unreal)) << unreal.last_error();
  Textures textures(unreal);
  EXPECT_LE(largest_difference(shoot(unreal, textures, camera()), reference(camera())), 1);
}

TEST_F(UnrealRefusals, AnotherRhi) {
  UnrealHabits habits;
  habits.draws_with_vulkan = false;
  ImitatedUnreal unreal(habits);
  VOYAGER_NEEDS_VULKAN(unreal);
  EXPECT_FALSE(open(unreal));
  EXPECT_NE(unreal.last_error().find("expected Vulkan"), std::string::npos) << unreal.last_error();
}

TEST_F(UnrealRefusals, AMissingSceneAndTexturesThatDoNotFit) {
  ImitatedUnreal unreal;
  VOYAGER_NEEDS_VULKAN(unreal);
  EXPECT_FALSE(open(unreal, "none.ply"));
  EXPECT_NE(unreal.last_error().find("VOY_ERROR_FILE_NOT_FOUND"), std::string::npos)
      << unreal.last_error();

  ASSERT_TRUE(open(unreal)) << unreal.last_error();
  Textures textures(unreal);
  UnrealView upscaled = view_of(textures, camera());
  upscaled.view.StubRawRect = FIntRect(0, 0, 48, 32);
  const size_t logged = unreal.log().size();
  for (int i = 0; i < 3; ++i) unreal.frame(upscaled);
  EXPECT_NE(unreal.last_error().find("found a scene of 48 x 32 pixels in a picture of 96 x 64"),
            std::string::npos)
      << unreal.last_error();
  EXPECT_EQ(unreal.log().size(), logged + 1) << "once, not in every frame";

  FRDGTexture multisampled({{kTextureWidth, kTextureHeight}, 4}, textures.depth.get());
  UnrealView view = view_of(textures, camera());
  view.depth = &multisampled;
  unreal.frame(view);
  EXPECT_NE(unreal.last_error().find("4 of depth, expected 1"), std::string::npos)
      << unreal.last_error();
  UnrealView flat = view_of(textures, camera());
  flat.view.ViewMatrices.StubProjection.M[2][3] = 0;
  unreal.frame(flat);
  EXPECT_NE(unreal.last_error().find("orthographic"), std::string::npos) << unreal.last_error();
  const std::vector<uint8_t> bytes = unreal.read(*textures.colour);
  EXPECT_TRUE(std::all_of(bytes.begin(), bytes.end(), [](uint8_t byte) { return byte == 0; }));
  EXPECT_LE(largest_difference(shoot(unreal, textures, camera()), reference(camera())), 1);
}

}  // namespace
}  // namespace unreal_refusal_test
}  // namespace voyager::test
