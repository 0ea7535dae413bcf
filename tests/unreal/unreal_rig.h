#pragma once
// Frames of the module in the imitated Unreal, and the same pictures by `voyager render`.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "../headless/scene_bytes.h"
#include "tests/command_line/rendered.h"
#include "tests/support/needs.h"
#include "tests/support/pictures.h"
#include "tests/support/test_support.h"
#include "tests/unreal/imitated_unreal.h"
#include "tests/unreal/unreal_camera.h"

namespace voyager::test {

// A picture of 96 x 64 pixels in a texture that is larger.
inline constexpr int32_t kLeft = 8, kTop = 4;
inline constexpr uint32_t kWidth = 96, kHeight = 64, kTextureWidth = 112, kTextureHeight = 72;

class UnrealModule : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    write_bytes(file("scene.ply"), ply_bytes(800));
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::string file(const std::string& name) { return folder_->file(name); }

  static FVector origin() { return {2e8, -1e8, 5e6}; }
  static UnrealCamera camera() {
    return UnrealCamera::at({origin().X - 1200, origin().Y + 100, origin().Z + 200}, -0.1, -0.15,
                            0.2);
  }
  static bool open(ImitatedUnreal& unreal, const std::string& name = "scene.ply") {
    return unreal.module().OpenScene(Widen(file(name)).c_str(), origin());
  }

  struct Textures {
    explicit Textures(const ImitatedUnreal& unreal, VkFormat format = VK_FORMAT_R8G8B8A8_UNORM,
                      VkFormat depth_format = VK_FORMAT_D32_SFLOAT_S8_UINT)
        : colour(unreal.make_texture(format, kTextureWidth, kTextureHeight)),
          depth(unreal.make_texture(depth_format, kTextureWidth, kTextureHeight)),
          colour_in_graph({{kTextureWidth, kTextureHeight}, 1}, colour.get()),
          depth_in_graph({{kTextureWidth, kTextureHeight}, 1}, depth.get()) {}
    std::unique_ptr<FRHITexture> colour, depth;
    FRDGTexture colour_in_graph, depth_in_graph;
  };
  static UnrealView view_of(Textures& textures, const UnrealCamera& camera,
                            float cleared_depth = 0) {
    const FIntRect rect(kLeft, kTop, kLeft + int32_t{kWidth}, kTop + int32_t{kHeight});
    const FSceneView view{{camera.position, camera.view_to_world(), camera.projection()}, rect};
    return {view, &textures.colour_in_graph, rect, &textures.depth_in_graph, cleared_depth};
  }

  // Some frames, the last of which had time to be drawn: RGB of the picture. What is around it
  // must be untouched.
  static Picture shoot(ImitatedUnreal& unreal, Textures& textures, const UnrealCamera& camera,
                       float cleared_depth = 0) {
    for (int i = 0; i < 5; ++i) unreal.frame(view_of(textures, camera, cleared_depth));
    return picture_of(unreal.read(*textures.colour));
  }
  static Picture picture_of(const std::vector<uint8_t>& rgba) {
    Picture picture{kWidth, kHeight, {}};
    for (uint32_t y = 0; y < kTextureHeight; ++y)
      for (uint32_t x = 0; x < kTextureWidth; ++x) {
        const bool inside = x - kLeft < kWidth && y - kTop < kHeight;
        for (size_t c = 0; c < 3; ++c) {
          const uint8_t value = rgba[4 * (size_t{y} * kTextureWidth + x) + c];
          if (inside)
            picture.values.push_back(value);
          else
            EXPECT_EQ(value, 0) << "at " << x << ", " << y;
        }
      }
    return picture;
  }

  static Picture reference(const UnrealCamera& camera) {
    return rendered(*folder_, "scene.ply", camera.cameras_json(kWidth, kHeight, origin()));
  }

  static inline TempFolder* folder_ = nullptr;
};

#define VOYAGER_NEEDS_VULKAN(unreal) \
  if (!(unreal).has_device()) VOYAGER_SKIP_WITHOUT(VULKAN, "no Vulkan device")

}  // namespace voyager::test
