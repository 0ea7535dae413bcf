// The picture in Unity's texture, whatever Unity's habits.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "tests/unity/unity_rig.h"

namespace voyager::test {
namespace unity_picture_test {
namespace {

struct Habit {
  const char* name;
  UnityHabits habits;
  friend void PrintTo(const Habit& habit, std::ostream* out) { *out << habit.name; }
};

class UnityPictures : public UnityPlugin, public ::testing::WithParamInterface<Habit> {};

UnityHabits on_thread() {
  UnityHabits habits;
  habits.submits_on_thread = true;
  return habits;
}
UnityHabits older() {
  UnityHabits habits;
  habits.has_v2 = false;
  habits.api_version = VK_API_VERSION_1_0;
  return habits;
}
UnityHabits with_features() {
  UnityHabits habits;
  habits.chains_vulkan_1_2 = true;
  return habits;
}

INSTANTIATE_TEST_SUITE_P(Of, UnityPictures,
                         ::testing::Values(Habit{"Usual", {}}, Habit{"OnAThread", on_thread()},
                                           Habit{"Older", older()},
                                           Habit{"WithFeatures", with_features()}),
                         [](const auto& each) { return std::string(each.param.name); });

TEST_P(UnityPictures, AreWhatVoyagerRenders) {
  ImitatedUnity unity(GetParam().habits);
  VOYAGER_NEEDS_VULKAN(unity);
  ASSERT_EQ(unity.last_error(), "");
  ASSERT_EQ(unity.open_scene(file("scene.ply").c_str()), 1) << unity.last_error();
  const auto colour = unity.make_texture(VK_FORMAT_R8G8B8A8_UNORM, kWidth, kHeight);
  for (const double x : {1.0, -3.0}) {
    UnityCamera at = camera();
    at.position[0] = x;
    const Picture drawn = shoot(unity, at, *colour);
    const Picture expected = reference(at);
    EXPECT_LE(largest_difference(drawn, expected), 1) << x;
    EXPECT_GT(*std::max_element(expected.values.begin(), expected.values.end()), 100);
  }
  EXPECT_EQ(unity.last_error(), "");
}

// Each with its own texture, in every frame.
TEST_F(UnityPlugin, TwoCamerasGetTheirOwnPictures) {
  ImitatedUnity unity;
  VOYAGER_NEEDS_VULKAN(unity);
  ASSERT_EQ(unity.open_scene(file("scene.ply").c_str()), 1) << unity.last_error();
  UnityCamera cameras[] = {camera(), camera()};
  cameras[1].position[0] = -4;
  std::unique_ptr<UnityTexture> textures[2];
  for (auto& texture : textures)
    texture = unity.make_texture(VK_FORMAT_R8G8B8A8_UNORM, kWidth, kHeight);
  for (int i = 0; i < 5; ++i) {
    std::vector<UnityCameraEvent> events;
    for (size_t c = 0; c < 2; ++c)
      events.push_back(
          {textures[c].get(), nullptr, 0, frame_data(unity, cameras[c], *textures[c])});
    unity.frame(events);
  }
  for (size_t c = 0; c < 2; ++c)
    EXPECT_LE(largest_difference(rgb_of(unity.read(*textures[c]), kWidth, kHeight),
                                 reference(cameras[c])),
              1)
        << c;
  EXPECT_EQ(unity.last_error(), "");
}

// On Unity's main thread, while the rendering thread draws.
TEST_F(UnityPlugin, ASceneIsReplacedWhileFramesAreDrawn) {
  ImitatedUnity unity;
  VOYAGER_NEEDS_VULKAN(unity);
  write_bytes(file("other.ply"), ply_bytes(50));
  const auto colour = unity.make_texture(VK_FORMAT_R8G8B8A8_UNORM, kWidth, kHeight);
  int opened = 0;
  std::atomic<bool> done = false;
  std::thread main([&] {
    for (const char* name : {"other.ply", "scene.ply", "other.ply", "scene.ply"})
      opened += unity.open_scene(file(name).c_str());
    done = true;
  });
  while (!done) unity.frame({{colour.get(), nullptr, 0, frame_data(unity, camera(), *colour)}});
  main.join();
  EXPECT_EQ(opened, 4);
  EXPECT_LE(largest_difference(shoot(unity, camera(), *colour), reference(camera())), 1);
  EXPECT_EQ(unity.last_error(), "");
}

TEST_F(UnityPlugin, FollowsATextureThatChangesSize) {
  ImitatedUnity unity;
  VOYAGER_NEEDS_VULKAN(unity);
  ASSERT_EQ(unity.open_scene(file("scene.ply").c_str()), 1) << unity.last_error();
  const auto first = unity.make_texture(VK_FORMAT_R8G8B8A8_SRGB, 64, 48);
  shoot(unity, camera(), *first);
  const auto second = unity.make_texture(VK_FORMAT_R8G8B8A8_UNORM, kWidth, kHeight);
  EXPECT_LE(largest_difference(shoot(unity, camera(), *second), reference(camera())), 1);
  EXPECT_EQ(unity.last_error(), "");
  VoyUnityStats stats = {};
  ASSERT_EQ(unity.statistics(&stats), 1) << unity.last_error();
  EXPECT_GT(stats.splats, 0u);
}

// One Gaussian of this colour, as a .ply has it. Positions are Unity's.
std::string gaussian(const Vector& at, int channel, float log_scale = -1.5f) {
  std::string row;
  const auto put = [&](float value) {
    row.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(static_cast<float>(at[0])), put(static_cast<float>(-at[1])), put(static_cast<float>(at[2]));
  for (int c = 0; c < 3; ++c) put(c == channel ? 1.7f : -1.7f);
  put(6);
  for (int k = 0; k < 3; ++k) put(log_scale);
  put(1), put(0), put(0), put(0);
  return row;
}

std::string ply_of(const std::vector<std::string>& gaussians) {
  std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                    std::to_string(gaussians.size()) + "\n";
  for (const char* name : {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0",
                           "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    ply += "property float " + std::string(name) + "\n";
  ply += "end_header\n";
  for (const std::string& each : gaussians) ply += each;
  return ply;
}

// Of a project in linear colour space. Transparent pixels are blended in linear light.
TEST_F(UnityPlugin, OpaquePixelsKeepTheirCodeValuesInAnSrgbTexture) {
  ImitatedUnity unity;
  VOYAGER_NEEDS_VULKAN(unity);
  write_bytes(file("opaque.ply"),
              ply_of(std::vector<std::string>(3, gaussian({0, 0, 0}, 1, 1.0f))));
  ASSERT_EQ(unity.open_scene(file("opaque.ply").c_str()), 1) << unity.last_error();
  const auto colour = unity.make_texture(VK_FORMAT_R8G8B8A8_SRGB, kWidth, kHeight);
  const std::vector<uint8_t> drawn = shoot_rgba(unity, camera(), *colour);
  const Picture expected = reference(camera(), "opaque.ply");
  size_t opaque = 0;
  for (size_t i = 0; i < drawn.size(); i += 4) {
    if (drawn[i + 3] != 255) continue;
    ++opaque;
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(drawn[i + c], expected.values[i / 4 * 3 + c], 1);
  }
  EXPECT_GT(opaque, 100u);
}

// A depth buffer that holds one plane, in Unity's reversed depth.
TEST_F(UnityPlugin, DepthHidesWhatIsBehind) {
  ImitatedUnity unity;
  VOYAGER_NEEDS_VULKAN(unity);
  ASSERT_EQ(unity.open_scene(file("scene.ply").c_str()), 1) << unity.last_error();
  const Picture whole = reference(camera());
  const Picture metres = read_pfm(file("depth.pfm"));
  constexpr float kPlane = 12;
  for (const VkFormat format :
       {VK_FORMAT_D16_UNORM, VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D24_UNORM_S8_UINT,
        VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT}) {
    SCOPED_TRACE(format);
    if (!unity.has_depth(format)) {
      std::cout << "the device has no depth format " << format << "\n";
      continue;
    }
    const auto colour = unity.make_texture(VK_FORMAT_R8G8B8A8_UNORM, kWidth, kHeight);
    const auto depth = unity.make_texture(format, kWidth, kHeight);
    const Picture drawn = shoot(unity, camera(), *colour, depth.get(),
                                camera().depth_at(static_cast<double>(kPlane)));
    size_t shown = 0, hidden = 0;
    for (size_t i = 0; i < metres.values.size(); ++i) {
      if (std::abs(metres.values[i] - kPlane) < 0.01f) continue;
      const bool before = metres.values[i] < kPlane;
      ++(before ? shown : hidden);
      for (size_t c = 3 * i; c < 3 * i + 3; ++c)
        EXPECT_NEAR(drawn.values[c], before ? whole.values[c] : 0, 1) << i;
    }
    EXPECT_GT(shown, 100u);
    EXPECT_GT(hidden, 100u);
  }
  EXPECT_EQ(unity.last_error(), "");
}

// The centre of a channel's light, -1 to 1, y upwards.
std::pair<double, double> centre(const Picture& picture, size_t channel) {
  double sum = 0, x = 0, y = 0;
  for (size_t i = 0; i < picture.values.size() / 3; ++i) {
    const double light = static_cast<double>(picture.values[3 * i + channel]);
    sum += light;
    x += light * static_cast<double>(i % picture.width);
    y += light * static_cast<double>(i / picture.width);
  }
  return {2 * (x / sum + 0.5) / picture.width - 1, 1 - 2 * (y / sum + 0.5) / picture.height};
}

TEST_F(UnityPlugin, LeftIsLeftAndUpIsUpAndAheadIsAhead) {
  ImitatedUnity unity;
  VOYAGER_NEEDS_VULKAN(unity);
  write_bytes(file("points.ply"), ply_of({gaussian({-3, 0, 10}, 0), gaussian({0, 2, 10}, 1),
                                          gaussian({0, 0, -10}, 2)}));
  ASSERT_EQ(unity.open_scene(file("points.ply").c_str()), 1) << unity.last_error();
  UnityCamera ahead = UnityCamera::at({0, 0, 0}, 0, 0, 0);
  ahead.left_edge = -(ahead.right_edge = 0.6);
  ahead.bottom_edge = -(ahead.top_edge = 0.4);
  const auto colour = unity.make_texture(VK_FORMAT_R8G8B8A8_UNORM, kWidth, kHeight);
  const Picture picture = shoot(unity, ahead, *colour);
  const auto [red_x, red_y] = centre(picture, 0);
  EXPECT_NEAR(red_x, -0.5, 0.03);
  EXPECT_NEAR(red_y, 0, 0.03);
  const auto [green_x, green_y] = centre(picture, 1);
  EXPECT_NEAR(green_x, 0, 0.03);
  EXPECT_NEAR(green_y, 0.5, 0.03);
  for (size_t i = 2; i < picture.values.size(); i += 3)
    ASSERT_LE(picture.values[i], 8) << "what is behind the camera is seen";
}

}  // namespace
}  // namespace unity_picture_test
}  // namespace voyager::test
