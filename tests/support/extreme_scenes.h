#pragma once
// METHOD §10: sizes, cameras and Gaussians at the edge, as shots for every backend to draw.
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/support/render_scene.h"
#include "tests/support/tree_clouds.h"

namespace voyager::test {

inline constexpr size_t kAnyPixel = SIZE_MAX;

struct ExtremeShot {
  std::string name;
  std::shared_ptr<const Scene> scene;
  FrameInput input;
  // Pixels that may lie on a threshold's other side in another backend; kAnyPixel where
  // rounding moves more than that.
  size_t rough = 0;
};

// Along the axis of a camera at the origin.
inline FrameInput ahead(uint32_t width, uint32_t height) {
  return frame_input(look({0, 0, 0}, {0, 0, 1}, width, height));
}

inline std::vector<ExtremeShot> size_shots() {
  const auto scene = baked_scene(random_cloud(800, 1, 1));
  std::vector<ExtremeShot> shots;
  for (const auto& [width, height] :
       {std::pair(1u, 1u), {17u, 5u}, {15u, 33u}, {16u, 16u}, {8192u, 16u}, {3u, 700u}})
    shots.push_back(
        {"size", scene, frame_input(look({2, -3, -22}, {0, 0, 0}, width, height), 3), 1});
  return shots;
}

inline std::vector<ExtremeShot> frustum_shots() {
  const auto scene = baked_scene(random_cloud(1500, 2, 1));
  std::vector<ExtremeShot> shots;
  for (const double fov : {1.0, 20.0, 120.0, 170.0})
    shots.push_back({"field of view " + std::to_string(fov), scene,
                     frame_input(look({0, 0, -15}, {0, 0, 0}, 80, 60, fov), 2), 2});
  for (const double centre : {-50.0, 0.0, 130.0}) {
    Camera camera = look({1, 0, -12}, {0, 0, 0}, 80, 60);
    camera.cx = centre, camera.cy = 60 - centre, camera.fy *= 1.3;
    shots.push_back({"centre " + std::to_string(centre), scene, frame_input(camera, 2), 2});
  }
  return shots;
}

// Without a background, then with one.
inline std::vector<ExtremeShot> empty_shots() {
  std::vector<ExtremeShot> shots;
  for (const auto& scene :
       {std::shared_ptr<const Scene>(empty_scene()), baked_scene(GaussianCloud())}) {
    FrameInput input = frame_input(look({0, 0, -3}, {0, 0, 0}, 37, 19));
    shots.push_back({"empty", scene, input});
    input.background = {0.1f, 0.2f, 0.3f};
    shots.push_back({"empty over a background", scene, input});
  }
  return shots;
}

inline ExtremeShot single_gaussian_shot() {
  auto scene = empty_scene();
  add_gaussian(*scene, {0, 0, 4}, {0.2f, 0.1f, 0.1f}, 0.8f, {1, 0.5f, 0});
  return {"single Gaussian", scene, ahead(64, 48)};
}

// Sheets across the whole image, so that one pixel is as good as another.
inline ExtremeShot sheets_shot() {
  auto scene = empty_scene();
  std::mt19937 random(1);
  for (int i = 0; i < 40; ++i)
    add_gaussian(*scene, {0, 0, 2.0f + static_cast<float>(random() % 1000) / 100},
                 {1e4f, 1e4f, 1e-6f}, static_cast<float>(random() % 20) / 100);
  return {"sheets", scene, ahead(3, 3)};
}

// A hundred thousand over one pixel, the last of the input in front.
inline ExtremeShot layers_shot(float opacity) {
  auto scene = empty_scene();
  for (int i = 0; i < 100000; ++i)
    add_gaussian(*scene, {0, 0, 1 + 1e-4f * static_cast<float>(99999 - i)}, {1, 1, 1e-4f}, opacity,
                 {0.6f, 0.7f, 0.8f});
  return {"layers of " + std::to_string(opacity), scene, ahead(4, 4)};
}

// Coplanar Gaussians with the camera's axis along the plane's normal.
inline ExtremeShot facade_shot() {
  auto scene = empty_scene();
  std::mt19937 random(4);
  for (int i = 0; i < 3000; ++i)
    add_gaussian(*scene,
                 {static_cast<float>(random() % 1000) / 100 - 5,
                  static_cast<float>(random() % 1000) / 100 - 5, 7.3f},
                 {0.2f, 0.2f, 1e-6f}, 0.9f,
                 {static_cast<float>(random() % 2), static_cast<float>(random() % 2), 0.2f});
  return {"facade", scene, frame_input(look({0.31, 0.17, 0}, {0.31, 0.17, 1}, 96, 96)), 4};
}

// Turned, so that depths differ by rounding only.
inline ExtremeShot turned_facade_shot() {
  const ExtremeShot square = facade_shot();
  auto scene = empty_scene();
  const Camera camera = look({0.3, 0.2, 0.1}, {3, -2, 5}, 96, 96);
  const Mat3d& w = camera.world_to_view;
  for (const Gaussian& g : square.scene->gaussians) {
    const Vec3d p =
        camera.eye + double{g.mean.x} * w.row[0] + double{g.mean.y} * w.row[1] + 7.3 * w.row[2];
    scene->gaussians.push_back(g);
    scene->gaussians.back().mean = {static_cast<float>(p.x), static_cast<float>(p.y),
                                    static_cast<float>(p.z)};
    scene->gaussians.back().scale = {0.2f, 0.2f, 0.2f};
  }
  scene->sh = square.scene->sh;
  return {"turned facade", scene, frame_input(camera), 4};
}

// Behind the near plane and on it, and, if so wanted, one just beyond.
inline ExtremeShot near_plane_shot(bool one_beyond) {
  auto scene = empty_scene();
  const float near = 0.2f;
  for (const float z : {-5.0f, -0.1f, 0.0f, near})
    add_gaussian(*scene, {0, 0, z}, {1, 1, 1}, 1, {1, 0, 0});
  if (one_beyond)
    add_gaussian(*scene, {0, 0, std::nextafter(near, 1.0f)}, {1e-3f, 1e-3f, 1e-3f}, 1, {0, 1, 0});
  return {"near plane", scene, ahead(20, 20)};
}

// METHOD §12 at its ends: no footprint, one between the sizes below, one that covers all.
inline const NativeScale kExtremeNatives[] = {{NativeSource::given, 0, kPixelVariance},
                                              {NativeSource::given, 0.05, kPixelVariance},
                                              {NativeSource::given, 1e6, kPixelVariance},
                                              {NativeSource::file, 0, kLowPass},
                                              {NativeSource::file, 0, 0}};

// From a nanometre up. native: unknown is 3DGS's picture, as below.
inline ExtremeShot scales_shot(const NativeScale& native = {}) {
  std::mt19937 random(5);
  auto scene = empty_scene();
  scene->native = native;
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int i = 0; i < 400; ++i) {
    const auto scale = [&] {
      return std::pow(10.0f, uniform(random) < 0 ? -9.0f + 3 * (1 + uniform(random))
                                                 : -1.5f + 1.5f * uniform(random));
    };
    add_gaussian(*scene, {5 * uniform(random), 5 * uniform(random), 6 + 5 * uniform(random)},
                 {scale(), scale(), scale()}, 0.5f + 0.5f * uniform(random),
                 {uniform(random) < 0 ? 0.1f : 0.9f, 0.4f, 0.6f},
                 {uniform(random), uniform(random), uniform(random), uniform(random)});
  }
  return {"scales", scene, ahead(90, 70), 8};
}

// At arm's length. Where rounding moves a needle by more than a pixel, backends part.
inline ExtremeShot needles_shot(float length, const NativeScale& native = {}) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> uniform(-1, 1);
  auto scene = empty_scene();
  scene->native = native;
  for (int i = 0; i < 100; ++i)
    add_gaussian(*scene, {uniform(random), uniform(random), 1 + uniform(random)},
                 {length, i % 2 ? length : 1e-9f, 1e-9f}, 0.3f, {0.2f, 0.7f, 0.6f},
                 {uniform(random), uniform(random), uniform(random), uniform(random)});
  return {"needles of " + std::to_string(length) + " m", scene, ahead(50, 40), kAnyPixel};
}
inline constexpr float kNeedleLengths[] = {1e3f, 1e6f, 1e12f, 1e18f};

inline ExtremeShot opacity_shot(float opacity, const NativeScale& native = {}) {
  auto scene = empty_scene();
  scene->native = native;
  add_gaussian(*scene, {0, 0, 4}, {0.1f, 0.1f, 0.1f}, opacity, {1, 1, 1});
  return {"opacity " + std::to_string(opacity), scene, ahead(65, 65)};
}
inline constexpr float kOpacities[] = {0.0f, 1e-38f, 0.0039f, 0.5f, 1.0f, 7.0f, 1e6f, 1e30f};

inline std::vector<ExtremeShot> wild_colour_shots() {
  GaussianCloud cloud = random_cloud(300, 7, 3);
  std::mt19937 random(7);
  for (float& c : cloud.sh) c = random() % 4 == 0 ? 3.4e38f : (random() % 2 ? -3.4e38f : c);
  const FrameInput input = frame_input(look({0, 0, -20}, {0, 0, 0}, 60, 50), 9);
  return {{"wild colours, flat", flat_scene(cloud), input, kAnyPixel},
          {"wild colours, baked", baked_scene(cloud), input, kAnyPixel}};
}

inline ExtremeShot negative_colour_shot() {
  auto scene = empty_scene();
  add_gaussian(*scene, {0, 0, 4}, {1, 1, 1}, 0.9f, {-5, 0.5f, -0.01f});
  return {"negative colour", scene, ahead(16, 16)};
}

// Points, lines, outliers at 9e17 m, specks, needles, invisible ones: as trees.
inline std::vector<ExtremeShot> degenerate_shots() {
  std::vector<ExtremeShot> shots;
  for (const NamedCloud& named : degenerate_clouds()) {
    const auto scene = baked_scene(named.cloud);
    for (const double tau : {0.0, 5.0, 1e3})
      for (const Vec3d& eye : {Vec3d{3, -6, -24}, Vec3d{0.1, 0.2, -1.5}})
        shots.push_back({named.name + ", tau " + std::to_string(tau), scene,
                         frame_input(look(eye, {0, 0, 0}, 40, 30), tau), kAnyPixel});
  }
  return shots;
}

inline std::vector<ExtremeShot> far_camera_shots() {
  const auto scene = baked_scene(random_cloud(500, 9, 1));
  std::vector<ExtremeShot> shots;
  for (const double far : {1e6, 1e12, 1e17, 9.9e17})
    shots.push_back({"camera at " + std::to_string(far) + " m", scene,
                     frame_input(look({far, 0, -far}, {0, 0, 0}, 20, 20)), kAnyPixel});
  return shots;
}

// In earth-centred coordinates: the means as they are, the origin far away.
inline std::shared_ptr<Scene> earth_centred_scene(const GaussianCloud& cloud) {
  auto scene = flat_scene(cloud);
  scene->origin = {6250.0 * 1024, -3000.0 * 1024, 4000.0 * 1024};
  return scene;
}

}  // namespace voyager::test
