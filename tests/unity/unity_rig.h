#pragma once
// Frames of the plugin in the imitated Unity, and the same pictures by `voyager render`.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "../headless/scene_bytes.h"
#include "tests/command_line/rendered.h"
#include "tests/support/needs.h"
#include "tests/support/pictures.h"
#include "tests/support/test_support.h"
#include "tests/unity/imitated_unity.h"
#include "tests/unity/unity_camera.h"

namespace voyager::test {

inline constexpr uint32_t kWidth = 96, kHeight = 64;

inline void* frame_data(const ImitatedUnity& unity, const UnityCamera& camera, UnityTexture& colour,
                        UnityTexture* depth = nullptr) {
  return unity.camera(camera.camera_to_world().data(), camera.projection().data(), camera.near_z,
                      camera.far_z, &colour, depth);
}

// RGB of a texture with four bytes a pixel.
inline Picture rgb_of(const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height) {
  Picture picture{width, height, {}};
  for (size_t i = 0; i < rgba.size(); ++i)
    if (i % 4 != 3) picture.values.push_back(rgba[i]);
  return picture;
}

class UnityPlugin : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    write_bytes(file("scene.ply"), ply_bytes(800));
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::string file(const std::string& name) { return folder_->file(name); }

  static UnityCamera camera() { return UnityCamera::at({1, 2, -12}, -0.1, -0.15, 0.2); }

  // What the texture holds after some frames, the last of which had time to be drawn: RGBA.
  static std::vector<uint8_t> shoot_rgba(ImitatedUnity& unity, const UnityCamera& camera,
                                         UnityTexture& colour, UnityTexture* depth = nullptr,
                                         float cleared_depth = 0) {
    for (int i = 0; i < 5; ++i)
      unity.frame({{&colour, depth, cleared_depth, frame_data(unity, camera, colour, depth)}});
    return unity.read(colour);
  }
  static Picture shoot(ImitatedUnity& unity, const UnityCamera& camera, UnityTexture& colour,
                       UnityTexture* depth = nullptr, float cleared_depth = 0) {
    return rgb_of(shoot_rgba(unity, camera, colour, depth, cleared_depth), colour.image.desc.width,
                  colour.image.desc.height);
  }

  // By `voyager render`, in the axes of the scene.
  static Picture reference(const UnityCamera& camera, const std::string& scene = "scene.ply") {
    return rendered(*folder_, scene, camera.cameras_json(kWidth, kHeight));
  }

  static inline TempFolder* folder_ = nullptr;
};

#define VOYAGER_NEEDS_VULKAN(unity) \
  if (!(unity).has_device()) VOYAGER_SKIP_WITHOUT(VULKAN, "no Vulkan device")

}  // namespace voyager::test
