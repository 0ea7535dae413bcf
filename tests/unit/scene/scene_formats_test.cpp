// The real scenes: the same block out of every format, and the odd files of other writers.
#include <algorithm>

#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::scene_formats_test {
namespace {

struct Difference {
  double position = 0, log_scale = 0, opacity = 0, rotation = 0, colour = 0, sh = 0;  // largest
};

// How far `b`, which went through .spz, is from `a`. Values that the format clamps are compared
// clamped.
Difference compare(const GaussianCloud& a, const GaussianCloud& b) {
  Difference most;
  const auto see = [](double& largest, double d) { largest = std::max(largest, std::fabs(d)); };
  for (size_t i = 0; i < a.position.size(); ++i)
    see(most.position, static_cast<double>(a.position[i]) - static_cast<double>(b.position[i]));
  for (size_t i = 0; i < a.log_scale.size(); ++i)
    see(most.log_scale,
        static_cast<double>(std::clamp(a.log_scale[i], -10.0f, 5.9375f) - b.log_scale[i]));
  const size_t width = static_cast<size_t>(a.coefficients()) * 3;
  for (size_t i = 0; i < a.size(); ++i) {
    see(most.opacity, static_cast<double>(sigmoid(a.opacity[i]) - sigmoid(b.opacity[i])));
    const Quatf p = normalise(a.words(i).rotation), q = normalise(b.words(i).rotation);
    see(most.rotation,
        1.0 - std::fabs(static_cast<double>(p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z)));
    for (size_t k = 0; k < width; ++k) {
      const float low = k < 3 ? -10.0f / 3 : -1.0f, high = k < 3 ? 10.0f / 3 : 127.0f / 128;
      see(k < 3 ? most.colour : most.sh,
          static_cast<double>(std::clamp(a.sh[i * width + k], low, high) - b.sh[i * width + k]));
    }
  }
  return most;
}

TEST(SceneFormats, TheBlockIsTheSameInPlyAndSpz) {
  VOYAGER_NEEDS_SCENES(folder);
  const GaussianCloud ply = test::import_file(folder + "/formats/block.ply");
  ASSERT_EQ(ply.size(), 19621u);
  for (const char* name : {"block.spz", "block_v3.spz"}) {
    const GaussianCloud spz = test::import_file(folder + "/formats/" + name);
    ASSERT_EQ(spz.size(), ply.size());
    ASSERT_EQ(spz.sh_degree, 3);
    const Difference d = compare(ply, spz);
    std::printf(
        "%s: position %.3g m, log scale %.3g, opacity %.3g, 1-|dot| %.3g, f_dc %.3g, sh %.3g\n",
        name, d.position, d.log_scale, d.opacity, d.rotation, d.colour, d.sh);
    EXPECT_LE(d.position, 1.0 / 4096);
    EXPECT_LE(d.log_scale, 1.0 / 16);
    EXPECT_LE(d.opacity, 1.0 / 255);
    EXPECT_LE(d.rotation, 1e-4);
    EXPECT_LE(d.colour, 1.0 / 255 / 0.15 + 1e-5);
    EXPECT_LE(d.sh, 8.5 / 128);  // their writer keeps four bits of the higher bands
  }
}

// What exp and sigmoid leave of a binary32 word is all that differs; opacities of 1 are logits
// beyond 16 in the .ply.
TEST(SceneFormats, TheBlockIsTheSameInPlyAndGlb) {
  VOYAGER_NEEDS_SCENES(folder);
  const GaussianCloud ply = test::import_file(folder + "/formats/block.ply");
  const GaussianCloud glb = test::import_file(folder + "/formats/block.glb");
  ASSERT_EQ(glb.size(), ply.size());
  EXPECT_EQ(glb.position, ply.position);
  EXPECT_EQ(glb.sh, ply.sh);
  Difference most;
  for (size_t i = 0; i < ply.rotation.size(); ++i)
    most.rotation = std::max(most.rotation, std::fabs(double{glb.rotation[i]} - ply.rotation[i]));
  for (size_t i = 0; i < ply.log_scale.size(); ++i)
    most.log_scale =
        std::max(most.log_scale, std::fabs(double{glb.log_scale[i]} - ply.log_scale[i]));
  for (size_t i = 0; i < ply.size(); ++i)
    most.opacity = std::max(most.opacity,
                            std::fabs(double{sigmoid(glb.opacity[i])} - sigmoid(ply.opacity[i])));
  std::printf("block.glb: position 0, SH 0, log scale %.3g, rotation %.3g, opacity %.3g\n",
              most.log_scale, most.rotation, most.opacity);
  EXPECT_LE(most.rotation, 2e-7);
  EXPECT_LE(most.log_scale, 1e-6);
  EXPECT_LE(most.opacity, 2e-7);
}

// Each node has the same Gaussian in another encoding. The file is of a draft of the extension:
// scales are logarithms.
TEST(SceneFormats, TheConformanceFilesOfGltf) {
  VOYAGER_NEEDS_SCENES(folder);
  const GaussianCloud glb = test::import_file(folder + "/formats/khr_conformance_matrix.glb");
  const GaussianCloud gltf = test::import_file(folder + "/formats/khr_conformance_matrix.gltf");
  ASSERT_EQ(glb.size(), 15u);
  EXPECT_EQ(glb.sh_degree, 3);
  EXPECT_EQ(glb.position, gltf.position);
  EXPECT_EQ(glb.sh, gltf.sh);
  for (size_t i = 0; i < glb.size(); ++i) {
    EXPECT_EQ(glb.words(i).mean, (Vec3f{-1, -2, 3})) << i;
    EXPECT_EQ(std::fabs(glb.words(i).rotation.y) + std::fabs(glb.words(i).rotation.z), 1.0f) << i;
  }
  EXPECT_EQ(glb.words(4).log_scale, (Vec3f{1, -2, 3}));
  EXPECT_EQ(glb.words(7).log_scale, (Vec3f{1, 0, -1}));
  EXPECT_NEAR(sigmoid(glb.opacity[8]), 0.75, 1e-6);
  EXPECT_NEAR(sigmoid(glb.opacity[9]), 64 / 255.0, 1e-6);
  EXPECT_NEAR(sigmoid(glb.opacity[10]), 16384 / 65535.0, 1e-6);
  // An unknown kernel and colour space fall back to the known ones, missing SH to COLOR_0.
  const GaussianCloud fallback =
      test::import_file(folder + "/formats/khr_extensible_fallback.gltf");
  ASSERT_EQ(fallback.size(), 1u);
  EXPECT_EQ(fallback.opacity[0], 0.0f);
  EXPECT_EQ(fallback.words(0).log_scale, (Vec3f{0, 0, 0}));
  // Its numbers are 1, 2, 3, and so are the bounds in glTF's axes. The node turns z up into y up.
  const GaussianCloud spz = test::import_file(folder + "/formats/spz_2_cesium.glb");
  ASSERT_EQ(spz.size(), 1u);
  EXPECT_EQ(spz.words(0).mean, (Vec3f{-1, -3, -2}));
}

TEST(SceneFormats, ThreePointsAreTheSameInPlyAndSpz) {
  VOYAGER_NEEDS_SCENES(folder);
  const std::string base = folder + "/formats/train-3points/test-splat.3-points-from-train.";
  const GaussianCloud ply = test::import_file(base + "ply"), spz = test::import_file(base + "spz");
  ASSERT_EQ(ply.size(), 3u);
  ASSERT_EQ(spz.size(), 3u);
  const Difference d = compare(ply, spz);
  EXPECT_LE(d.position, 1.0 / 4096);
  EXPECT_LE(d.log_scale, 1.0 / 16);
  EXPECT_LE(d.opacity, 1.0 / 255);
  EXPECT_LE(d.rotation, 1e-4);
  EXPECT_LE(d.colour, 1.0 / 255 / 0.15 + 1e-5);
  EXPECT_LE(d.sh, 8.5 / 128);
}

// The v2 and v3 files were made with different axes, so they are compared two by two.
TEST(SceneFormats, EveryVersionOfTheMinimalScene) {
  VOYAGER_NEEDS_SCENES(folder);
  for (const auto& [one, other] : {std::pair("minimal-raw.spz", "minimal-v2.spz"),
                                   std::pair("minimal-v3.spz", "minimal-v4.spz")}) {
    const GaussianCloud a = test::import_file(folder + "/formats/" + one);
    const GaussianCloud b = test::import_file(folder + "/formats/" + other);
    ASSERT_EQ(a.size(), 4u) << one;
    ASSERT_EQ(b.size(), 4u) << other;
    EXPECT_EQ(a.position, b.position) << one;
    EXPECT_EQ(a.opacity, b.opacity) << one;
    EXPECT_EQ(a.log_scale, b.log_scale) << one;
    EXPECT_EQ(a.sh, b.sh) << one;
    for (size_t i = 0; i < a.rotation.size(); ++i)
      EXPECT_NEAR(a.rotation[i], b.rotation[i], 0.002) << one << i;
    EXPECT_NEAR(sigmoid(a.opacity[0]), 0.9, 1.0 / 255);
  }
}

TEST(SceneFormats, TheDistrictAndTheObjectAreSound) {
  VOYAGER_NEEDS_SCENES(folder);
  const GaussianCloud district = test::import_file(folder + "/district.spz");
  EXPECT_EQ(district.size(), 777299u);
  EXPECT_EQ(district.sh_degree, 3);
  EXPECT_EQ(district.report.dropped() + district.report.repaired(), 0u);
  const GaussianCloud object = test::import_file(folder + "/formats/playbot_lod3.ply");
  EXPECT_EQ(object.size(), 31000u);
  EXPECT_EQ(object.sh_degree, 2);
}

}  // namespace
}  // namespace voyager::scene_formats_test
