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

}  // namespace
}  // namespace voyager::tree_quality_test
