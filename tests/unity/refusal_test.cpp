// Where the plugin cannot draw, it says why, and Unity goes on.
#include <algorithm>

#include "tests/unity/unity_rig.h"

namespace voyager::test {
namespace unity_refusal_test {
namespace {

using UnityRefusals = UnityPlugin;

// Frames go by, and the texture stays as Unity cleared it.
void expect_unity_goes_on(ImitatedUnity& unity, const UnityCamera& camera) {
  const auto colour = unity.make_texture(VK_FORMAT_R8G8B8A8_UNORM, kWidth, kHeight);
  for (int i = 0; i < 4; ++i)
    unity.frame({{colour.get(), nullptr, 0, frame_data(unity, camera, *colour)}});
  const std::vector<uint8_t> bytes = unity.read(*colour);
  EXPECT_TRUE(std::all_of(bytes.begin(), bytes.end(), [](uint8_t byte) { return byte == 0; }));
}

void expect_absent(const UnityHabits& habits, const std::string& scene, const UnityCamera& camera,
                   const std::string& reason) {
  ImitatedUnity unity(habits);
  VOYAGER_NEEDS_VULKAN(unity);
  EXPECT_NE(unity.last_error().find(reason), std::string::npos) << unity.last_error();
  EXPECT_EQ(unity.open_scene(scene.c_str()), 0);
  EXPECT_NE(unity.last_error().find(reason), std::string::npos) << unity.last_error();
  expect_unity_goes_on(unity, camera);
}

TEST_F(UnityRefusals, ADriverWithoutExtensions) {
  UnityHabits habits;
  habits.offers_extensions = false;
  expect_absent(habits, file("scene.ply"), camera(), "VOY_ERROR_UNSUPPORTED");
}

TEST_F(UnityRefusals, APluginThatIsLoadedLate) {
  UnityHabits habits;
  habits.loads_at_startup = false;
  expect_absent(habits, file("scene.ply"), camera(), "Load on startup");
}

TEST_F(UnityRefusals, AnotherGraphicsApi) {
  UnityHabits habits;
  habits.renderer = static_cast<UnityGfxRenderer>(17);  // OpenGL
  expect_absent(habits, file("scene.ply"), camera(), "expected Vulkan");
}

TEST_F(UnityRefusals, AMissingSceneAndTexturesThatDoNotFit) {
  ImitatedUnity unity;
  VOYAGER_NEEDS_VULKAN(unity);
  EXPECT_EQ(unity.open_scene(file("none.ply").c_str()), 0);
  EXPECT_NE(unity.last_error().find("VOY_ERROR_FILE_NOT_FOUND"), std::string::npos)
      << unity.last_error();
  expect_unity_goes_on(unity, camera());

  ASSERT_EQ(unity.open_scene(file("scene.ply").c_str()), 1) << unity.last_error();
  const auto colour = unity.make_texture(VK_FORMAT_R8G8B8A8_UNORM, kWidth, kHeight);
  colour->samples = VK_SAMPLE_COUNT_4_BIT;
  unity.frame({{colour.get(), nullptr, 0, frame_data(unity, camera(), *colour)}});
  EXPECT_NE(unity.last_error().find("found 4 samples"), std::string::npos) << unity.last_error();
  colour->samples = VK_SAMPLE_COUNT_1_BIT;
  const auto small = unity.make_texture(VK_FORMAT_D32_SFLOAT, kWidth / 2, kHeight);
  unity.frame({{colour.get(), small.get(), 0, frame_data(unity, camera(), *colour, small.get())}});
  EXPECT_NE(unity.last_error().find("the depth texture"), std::string::npos) << unity.last_error();
  EXPECT_LE(largest_difference(shoot(unity, camera(), *colour), reference(camera())), 1);
}

TEST_F(UnityRefusals, ACameraThatIsScaledIsRefusedAndDrawsNothing) {
  ImitatedUnity unity;
  VOYAGER_NEEDS_VULKAN(unity);
  ASSERT_EQ(unity.open_scene(file("scene.ply").c_str()), 1) << unity.last_error();
  const auto colour = unity.make_texture(VK_FORMAT_R8G8B8A8_UNORM, kWidth, kHeight);
  UnityCamera scaled = camera();
  for (double& each : scaled.up) each *= 2;
  EXPECT_EQ(frame_data(unity, scaled, *colour), nullptr);
  EXPECT_NE(unity.last_error().find("the matrix scales"), std::string::npos) << unity.last_error();
  const Picture drawn = shoot(unity, scaled, *colour);
  EXPECT_EQ(*std::max_element(drawn.values.begin(), drawn.values.end()), 0);
  EXPECT_LE(largest_difference(shoot(unity, camera(), *colour), reference(camera())), 1);
}

}  // namespace
}  // namespace unity_refusal_test
}  // namespace voyager::test
