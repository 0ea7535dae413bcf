// What the clustered tree is for: a better picture from as many Gaussians.
#include "runtime/scene/append.h"
#include "tests/support/render_scene.h"
#include "tests/support/tree_rules.h"
#include "tools/synth/city.h"

namespace voyager::tree_quality_test {
namespace {

GaussianCloud city(uint64_t gaussians) {
  GaussianCloud all;
  all.sh_degree = 1;
  synth::generate_city(
      {.gaussians = gaussians, .seed = 7, .sh_degree = 1},
      [&](const GaussianCloud& part) { append(all, GaussianCloud(part), "city"); });
  return all;
}

class Tree {
 public:
  Tree(const GaussianCloud& cloud, const TreeRule& rule)
      : scene_(test::baked_scene(cloud, Quality::lossless, rule)) {}

  test::Frame draw(const Camera& camera, double tau) {
    return test::render(*backend_, scene_, {}, test::frame_input(camera, tau, false));
  }

  test::Frame draw_leaves(const Camera& camera, Antialias antialias = Antialias::on) {
    return test::render(*backend_, scene_, {.lod = Lod::all_leaves, .antialias = antialias},
                        test::frame_input(camera, 0, false));
  }

  // METHOD §12's, with 8 × 8 samples a pixel.
  test::Frame draw_truth(const Camera& camera) {
    constexpr uint32_t kSamples = 8;
    Camera fine = camera;
    fine.width *= kSamples, fine.height *= kSamples;
    fine.fx *= kSamples, fine.fy *= kSamples, fine.cx *= kSamples, fine.cy *= kSamples;
    const test::Frame samples = draw_leaves(fine, Antialias::truth);
    test::Frame truth;
    truth.width = camera.width, truth.height = camera.height;
    truth.rgba.assign(size_t{4} * camera.width * camera.height, 0.0f);
    for (uint32_t y = 0; y < fine.height; ++y)
      for (uint32_t x = 0; x < fine.width; ++x)
        for (size_t k = 0; k < 4; ++k)
          truth.rgba[4 * (size_t{y / kSamples} * camera.width + x / kSamples) + k] +=
              samples.at(x, y)[k] / float{kSamples * kSamples};
    return truth;
  }

  // With about as many nodes in the cut as there may be.
  test::Frame draw_cut_of(const Camera& camera, size_t nodes) {
    double least = 0.01, most = 1000;
    for (int i = 0; i < 14; ++i) {
      const double tau = std::sqrt(least * most);
      (draw(camera, tau).cut.size() > nodes ? least : most) = tau;
    }
    return draw(camera, most);
  }

 private:
  std::unique_ptr<Backend> backend_ = create_cpu_backend();
  std::shared_ptr<const Scene> scene_;
};

TEST(TreeQuality, AtAnEqualCutTheClusteredTreeIsThreeDecibelsAboveHierarchicalGs) {
  const GaussianCloud cloud = city(30000);
  Tree clustered(cloud, {}), compatible(cloud, test::kHierarchicalGs);
  const Camera cameras[] = {test::look({-60, -50, -60}, {20, 0, 20}, 240, 160),
                            test::look({30, -80, 30}, {31, 0, 32}, 240, 160)};
  for (const Camera& camera : cameras) {
    const test::Frame all = compatible.draw(camera, 0);
    ASSERT_EQ(all.cut.size(), cloud.size());
    for (const size_t share : {2, 4}) {
      const test::Frame ours = clustered.draw_cut_of(camera, cloud.size() / share);
      const test::Frame theirs = compatible.draw_cut_of(camera, cloud.size() / share);
      ASSERT_GE(ours.cut.size(), cloud.size() / share * 9 / 10);
      ASSERT_LE(ours.cut.size(), theirs.cut.size() * 101 / 100);
      const double gain = test::compare(all, ours).psnr - test::compare(all, theirs).psnr;
      EXPECT_GE(gain, 3) << "1/" << share << ": " << test::compare(all, theirs).psnr << " dB, "
                         << ours.cut.size() << " and " << theirs.cut.size() << " Gaussians";
    }
  }
}

double squared_error(const test::Frame& a, const test::Frame& b) {
  double sum = 0;
  for (size_t i = 0; i < a.rgba.size(); ++i) {
    const double d = double{a.rgba[i]} - b.rgba[i];
    sum += i % 4 == 3 ? 0 : d * d;
  }
  return 255 * 255 * sum / (3 * static_cast<double>(a.rgba.size() / 4));
}

// docs/lod-tree.md, "What τ gives": from afar, from near by and in a street.
TEST(TreeQuality, WhatACutLosesIsWithinWhatTauPromises) {
  Tree tree(city(30000), {});
  const Camera cameras[] = {test::look({-300, -300, -300}, {31, 0, 32}, 160, 90, 120),
                            test::look({-60, -50, -60}, {20, 0, 20}, 160, 90),
                            test::look({14, -1.7, -20}, {16, -2, 30}, 160, 90)};
  for (const Camera& camera : cameras) {
    const test::Frame truth = tree.draw_truth(camera);
    const double leaves = squared_error(tree.draw_leaves(camera), truth);
    for (const double tau : {0.5, 1.0, 3.0, 6.0, 12.0}) {
      const test::Frame cut = tree.draw(camera, tau);
      const double lost = squared_error(cut, truth) - leaves;
      if (tau >= 6) {
        EXPECT_LT(cut.cut.size(), 25000u);
      }
      EXPECT_LT(std::sqrt(std::max(lost, 0.0)), 1.1 * (2 * tau + 1)) << tau;
    }
  }
}

}  // namespace
}  // namespace voyager::tree_quality_test
