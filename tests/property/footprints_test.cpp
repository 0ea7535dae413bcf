// METHOD §12: each block of Gaussians is drawn as large as its own training pictures saw it.
#include "runtime/lod/summarise.h"
#include "runtime/lod/validate.h"
#include "runtime/refine/picture.h"
#include "tests/support/mixed_footprints.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_files.h"
#include "tests/support/stream_rig.h"
#include "tests/support/tree_clouds.h"

namespace voyager::footprints_test {
namespace {

using test::frame_input;
using test::look;
using test::render;

constexpr double kNear = 10, kFar = 150;  // metres before the camera

GaussianCloud cluster_at(double z, uint32_t seed) {
  GaussianCloud cloud = test::random_cloud(2048, seed, 0, 2);
  for (size_t i = 0; i < cloud.size(); ++i)
    cloud.position[3 * i + 2] = 0.05f * cloud.position[3 * i + 2] + static_cast<float>(z);
  return cloud;
}

GaussianCloud both_clusters() {
  GaussianCloud cloud = cluster_at(kNear, 1);
  const GaussianCloud far = cluster_at(kFar, 2);
  const auto add = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  add(cloud.position, far.position);
  add(cloud.log_scale, far.log_scale);
  add(cloud.rotation, far.rotation);
  add(cloud.opacity, far.opacity);
  add(cloud.sh, far.sh);
  return cloud;
}

// A picture that has no other cluster in it.
FrameInput only(double z) {
  const double side = z == kNear ? 1 : -1;
  return frame_input(look({1, -1, z + 9 * side}, {0, 0, z}, 160, 120));
}

TEST(Footprints, EachClusterIsDrawnAsAloneWithItsOwnPixel) {
  const std::vector<TrainingCamera> cameras{test::training_camera({0, 0, 0})};
  const auto cpu = create_cpu_backend();
  for (const TreeRule& rule : {TreeRule{}, test::kSmallBlocks, test::kHierarchicalGs}) {
    const BakedScene baked = test::bake_by_cameras(both_clusters(), cameras, rule);
    EXPECT_TRUE(validate(baked).empty());
    const NativeScale& native = baked.leaves.native;
    const int near = native.level_of(kNear / 500), far = native.level_of(kFar / 500);
    ASSERT_GT(near, far + 5);
    for (uint32_t n = 0; n < baked.tree.size(); ++n) {
      if (!baked.tree.is_leaf(n)) continue;
      ASSERT_EQ(footprint_level_of(baked.node_code[n]), baked.gaussian[n] < 2048 ? near : far);
    }
    EXPECT_EQ(footprint_level_of(baked.node_code[0]), near);
    const auto scene = test::loaded(baked);
    const PipelineDesc leaves{.lod = Lod::all_leaves};
    for (const auto& [z, seed, level] : {std::tuple{kNear, 1u, near}, {kFar, 2u, far}}) {
      auto alone = test::flat_scene(cluster_at(z, seed));
      alone->native = {NativeSource::given, native.pixel_of(level), kPixelVariance};
      const test::Frame found = render(*cpu, scene, leaves, only(z));
      EXPECT_GT(compare(found, render(*cpu, alone, leaves, only(z))).psnr, 100) << z;
      // Another cluster's shows.
      alone->native.pixel = native.pixel_of(near + far - level);
      EXPECT_LT(compare(found, render(*cpu, alone, leaves, only(z))).psnr, 50) << z;
      EXPECT_GT(found.rgba[4 * (60 * 160 + 80) + 3], 0.5f);
    }
  }
}

TEST(Footprints, OfWhatIsMergedNothingIsLost) {
  const BakedScene baked =
      test::bake_by_cameras(test::random_cloud(6000, 8, 0), test::close_camera());
  EXPECT_TRUE(validate(baked).empty());
  size_t mixed = 0;
  for (uint32_t n = 0; n < baked.tree.size(); ++n) {
    if (baked.tree.is_leaf(n)) continue;
    std::vector<MergeInput> children;
    double total = 0, least = INFINITY, most = 0;
    for (uint32_t i = 0; i < baked.tree.records[n].child_count; ++i) {
      const uint32_t child = baked.tree.first_child[n] + i;
      children.push_back(node_gaussian(child, baked));
      children.back().weight = double{baked.exposure[child].weight};
      total += children.back().weight;
      least = std::min(least, baked.footprint_of(child));
      most = std::max(most, baked.footprint_of(child));
    }
    ASSERT_EQ(baked.footprint_of(n), least);
    mixed += most > least;
    if (!(total > 0)) continue;
    Moments expected = moments(children);
    const MergeInput parent = node_gaussian(n, baked);
    Moments found = moments({&parent, 1});
    for (const int diagonal : {0, 3, 5}) {
      found.covariance[diagonal] += baked.footprint_of(n);
      for (uint32_t i = 0; i < children.size(); ++i)
        expected.covariance[diagonal] +=
            children[i].weight / total * baked.footprint_of(baked.tree.first_child[n] + i);
    }
    const double* c = expected.covariance;
    for (int k = 0; k < 6; ++k)
      ASSERT_NEAR(found.covariance[k], c[k], 1e-5 * (c[0] + c[3] + c[5])) << "node " << n;
  }
  EXPECT_GT(mixed, 10u);
}

TEST(Footprints, PicturesFromOneDistanceGiveTheSceneOneFootprint) {
  const std::vector<TrainingCamera> cameras{test::training_camera({0, 0, -2000}, 20000)};
  GaussianCloud cloud = test::random_cloud(3000, 5, 0);
  const BakedScene found = test::bake_by_cameras(cloud, cameras);
  cloud.native = {NativeSource::cameras, native_pixel(cameras, cloud).median, kPixelVariance};
  const BakedScene expected = test::bake(cloud, test::kSmallBlocks);
  for (const Quality quality : {Quality::lossless, Quality::compact})
    EXPECT_TRUE(test::scene_bytes(found, quality) == test::scene_bytes(expected, quality));
}

TEST(Footprints, ABlockThatNoCameraSeesHasTheGivenLevel) {
  GaussianCloud cloud = test::random_cloud(64, 3, 0);
  cloud.native = {NativeSource::cameras, 1, kPixelVariance, kFootprintLevels};
  std::vector<uint32_t> all(cloud.size());
  for (uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  const std::vector<TrainingCamera> away{test::training_camera({0, 0, 500})},
      before{test::training_camera({0, 0, -500})};
  EXPECT_EQ(footprint_level(cloud, all, {away, 6}), 6);
  EXPECT_EQ(footprint_level(cloud, all, {before, 6}), 0);  // pixels of a metre
  for (float& opacity : cloud.opacity) opacity = -5;       // too faint to say anything
  EXPECT_EQ(footprint_level(cloud, all, {before, 6}), 6);
}

TEST(Footprints, RefiningSeesEachNodeWithItsOwn) {
  Workers workers;
  BakedScene baked = test::bake_by_cameras(test::specks(3000, 4, 0), test::close_camera());
  const Viewpoints viewpoints(baked);
  const NodeArrays arrays(baked, workers);
  baked.leaves.native.levels = 1;
  const NodeArrays of_one(baked, workers);
  size_t compared = 0;
  for (uint32_t n = 0; n < baked.tree.size(); ++n) {
    const ProjectParams params = picture_params(viewpoints(n % 16), baked.leaves.native);
    ProjectParams own = params;
    own.filter.footprint = static_cast<float>(baked.footprint_of(n));
    const auto found = splat_of(params, arrays, n);
    const auto expected = splat_of(own, of_one, n);
    ASSERT_EQ(found.has_value(), expected.has_value());
    if (!found) continue;
    ASSERT_EQ(found->opacity, expected->opacity);
    ASSERT_EQ(found->half_width, expected->half_width);
    ++compared;
  }
  EXPECT_GT(compared, 100u);
}

TEST(Footprints, AStreamedSceneIsDrawnAsOneThatIsWhole) {
  const BakedScene baked =
      test::bake_by_cameras(test::random_cloud(4000, 7, 1), test::close_camera());
  test::StreamRig rig(baked, 1.0, {}, kDefaultChunkBytes, Quality::compact);
  for (const double tau : {0.0, 6.0, 30.0}) {
    FrameInput input = frame_input(look({3, -6, -24}, {0, 0, 0}, 160, 100), tau);
    input.wait_resident = true;
    test::expect_same_bits(render(rig.part, input), render(rig.whole, input));
  }
}

}  // namespace
}  // namespace voyager::footprints_test
