// A scene that is transformed, drawn by a camera that is transformed alike, gives the same picture.
#include "runtime/scene/transform.h"

#include <algorithm>
#include <cstdio>

#include "runtime/base/error.h"
#include "tests/support/gltf_files.h"
#include "tests/support/render_scene.h"
#include "tests/support/transforms.h"

namespace voyager::transform_test {
namespace {

constexpr std::array<double, 3> kOrigin{0, 0, 0};

// Its footprint grows with the scene.
GaussianCloud cloud_of(int sh_degree) {
  GaussianCloud cloud = test::random_cloud(600, 11, sh_degree);
  for (float& s : cloud.log_scale) s += 0.8f;
  return cloud;
}

// What `camera` sees of a scene, it then sees of the scene that `similar` took elsewhere.
Camera moved(Camera camera, const Affine& similar) {
  const double scale = std::cbrt(std::fabs(determinant(similar.linear)));
  camera.eye = similar * camera.eye;
  camera.world_to_view = camera.world_to_view * transposed(test::times(1 / scale, similar.linear));
  return camera;
}

TEST(Transform, ASimilarSceneIsTheSamePictureForASimilarCamera) {
  const auto cpu = create_cpu_backend();
  const Camera camera = test::look({3, -6, -24}, {0, 0, 0}, 160, 100);
  const std::vector<Affine> transforms = {
      {test::turn(0.8, 0.2, -0.5, 0.3), {3, -2, 5}},
      {test::times(2.5, test::turn(0.1, 0.9, 0.3, -0.2)), {0, 10, 0}},
      {test::diagonal(-1, 1, 1), {0, 0, 0}},
      {test::times(0.4, test::diagonal(1, 1, -1) * test::turn(0.3, 0.5, 0.1, 0.7)), {1, 2, 3}},
  };
  for (const int degree : {1, 3}) {
    const GaussianCloud cloud = cloud_of(degree);
    const auto expected =
        test::render(*cpu, test::flat_scene(cloud), {}, test::frame_input(camera, 3, false));
    for (const Affine& transform : transforms) {
      GaussianCloud there = cloud;
      CloudTransform(transform, "test").apply(there, kOrigin);
      const auto found = test::render(*cpu, test::flat_scene(there), {},
                                      test::frame_input(moved(camera, transform), 3, false));
      const double psnr = test::compare(found, expected).psnr;
      std::printf("SH degree %d: %.1f dB\n", degree, psnr);
      EXPECT_GE(psnr, 60) << degree;
      // What was not transformed is another picture.
      EXPECT_LT(test::compare(test::render(*cpu, test::flat_scene(cloud), {},
                                           test::frame_input(moved(camera, transform), 3, false)),
                              expected)
                    .psnr,
                40);
    }
  }
}

// A node of a glTF file, turned, scaled and mirrored; its axes are half a turn about z from
// INRIA's.
TEST(Transform, ANodeIsTheSamePictureForASimilarCamera) {
  const auto cpu = create_cpu_backend();
  const Camera camera = test::look({3, -6, -24}, {0, 0, 0}, 160, 100);
  GaussianCloud cloud = cloud_of(3);
  cloud.native = {};
  const auto draw = [&](const GaussianCloud& of, const Camera& from) {
    auto scene = test::flat_scene(of);
    scene->native = {NativeSource::given, 0, kPixelVariance};
    return test::render(*cpu, scene, {}, test::frame_input(from, 3, false));
  };
  const GaussianCloud placed =
      test::import_source(test::gltf_of(cloud, {{"translation", {1, 2, 3}},
                                                {"rotation", {0.1, 0.7, -0.1, 0.7}},
                                                {"scale", {1.5, -1.5, 1.5}}})
                              .glb());
  const Mat3d half = test::diagonal(-1, -1, 1);
  const Mat3d linear =
      half * test::turn(0.7, 0.1, 0.7, -0.1) * test::diagonal(1.5, -1.5, 1.5) * half;
  const double psnr =
      test::compare(draw(placed, moved(camera, {linear, {-1, -2, 3}})), draw(cloud, camera)).psnr;
  std::printf("mirrored node: %.1f dB\n", psnr);
  EXPECT_GE(psnr, 60);
}

Mat3d covariance(const GaussianWords& words) {
  const Mat3d r = rotation(
      normalise(Quatd{words.rotation.w, words.rotation.x, words.rotation.y, words.rotation.z}));
  const Mat3d shape =
      r * test::diagonal(std::exp(double{words.log_scale.x}), std::exp(double{words.log_scale.y}),
                         std::exp(double{words.log_scale.z}));
  return shape * transposed(shape);
}

TEST(Transform, AnyTransformMapsTheCovariance) {
  const GaussianCloud cloud = test::random_cloud(200, 3, 2);
  const Mat3d linear = test::turn(0.7, 0.1, 0.3, -0.5) * test::diagonal(3, 0.5, -1.5) *
                       test::turn(0.2, 0.8, -0.3, 0.4);
  const CloudTransform transform({linear, {1, 2, 3}}, "test");
  GaussianCloud there = cloud;
  transform.apply(there, kOrigin);
  for (size_t i = 0; i < cloud.size(); ++i) {
    const Mat3d expected = linear * covariance(cloud.words(i)) * transposed(linear);
    const Mat3d found = covariance(there.words(i));
    const double size =
        std::sqrt(dot(expected.row[0], expected.row[0]) + dot(expected.row[1], expected.row[1]) +
                  dot(expected.row[2], expected.row[2]));
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        EXPECT_NEAR(found.row[row][column], expected.row[row][column], 1e-5 * size) << i;
  }
}

// Without a length a rotation is the identity, which turns with the scene.
TEST(Transform, ARotationWithoutLengthTurns) {
  const Affine turned{{{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}, {0, 0, 0}};
  for (const double stretch : {1.0, 2.0}) {
    Affine affine = turned;
    affine.linear.row[2].z = stretch;
    GaussianCloud with = test::random_cloud(1, 3, 0), without = with;
    std::fill(with.rotation.begin(), with.rotation.end(), 0.0f);
    with.rotation[0] = 1;
    std::fill(without.rotation.begin(), without.rotation.end(), 0.0f);
    for (GaussianCloud* cloud : {&with, &without})
      CloudTransform(affine, "x").apply(*cloud, kOrigin);
    EXPECT_EQ(with.rotation, without.rotation);
    EXPECT_EQ(without.report.repaired_rotation, 1u);
  }
}

// A flat disc stays one, however thin: its axes are not taken from the square of their ratio.
TEST(Transform, ThinDiscsKeepTheirThickness) {
  GaussianCloud cloud = test::random_cloud(50, 5, 0);
  for (size_t i = 0; i < cloud.size(); ++i) cloud.log_scale[3 * i] = std::log(1e-8f);
  GaussianCloud there = cloud;
  CloudTransform({test::diagonal(2, 1, 1), {}}, "test").apply(there, kOrigin);
  for (size_t i = 0; i < there.size(); ++i) {
    const float* s = &there.log_scale[3 * i];
    const float least = std::min({s[0], s[1], s[2]});
    EXPECT_GT(least, std::log(0.9e-8f));
    EXPECT_LT(least, std::log(2.1e-8f));
  }
}

TEST(Transform, FarAwayIsRelativeToTheOrigin) {
  GaussianCloud cloud = test::random_cloud(20, 2, 0);
  const std::vector<float> before(cloud.position.begin(), cloud.position.end());
  const Affine far{kIdentity, {6378137.0, -2.0e6, 12.5}};
  const std::array<double, 3> origin = origin_near(far.offset);
  EXPECT_EQ(origin[2], 0);
  CloudTransform(far, "test").apply(cloud, origin);
  for (size_t i = 0; i < before.size(); ++i)
    EXPECT_NEAR(cloud.origin[i % 3] + double{cloud.position[i]},
                far.offset[static_cast<int>(i % 3)] + double{before[i]}, 1e-4);
}

TEST(Transform, WhatHasNoVolumeIsRefused) {
  for (const Affine& bad :
       {Affine{test::diagonal(1, 0, 1), {}}, Affine{test::diagonal(1, 1, NAN), {}},
        Affine{test::diagonal(1e10, 1, 1), {}}, Affine{kIdentity, {0, INFINITY, 0}}}) {
    try {
      CloudTransform(bad, "scene.ply: --transform");
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::refused_input);
      EXPECT_EQ(std::string(error.what()).rfind("scene.ply: --transform: found", 0), 0u);
    }
  }
}

}  // namespace
}  // namespace voyager::transform_test
