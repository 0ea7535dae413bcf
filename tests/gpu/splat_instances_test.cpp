// Several scenes in one view on the device: one picture, and that of the CPU and the reference.
#include "cuda/device/buffer.h"
#include "tests/gpu/agreement.h"
#include "tests/gpu/guarded_image.h"
#include "tests/gpu/splat_test.h"
#include "tests/support/instances.h"
#include "tests/support/scene_files.h"

namespace voyager::test {
namespace splat_instances_test {
namespace {

constexpr Splatting kSplattings[] = {Splatting::ours, Splatting::baseline_3dgs};

class SplatInstances : public SplatTest {
 protected:
  std::unique_ptr<View> view_of(Backend& backend, const Scenes& scenes,
                                const PipelineDesc& desc = {}) {
    return std::make_unique<View>(scenes, backend, desc, std::pmr::get_default_resource(), workers);
  }
  Frame draw_all(const Scenes& scenes, const PipelineDesc& desc, const FrameInput& input) {
    return render(*view_of(*cuda, scenes, desc), input);
  }
};

TEST_F(SplatInstances, HalvesThatOverlapAreTheWholeSceneToTheBit) {
  const GaussianCloud cloud = random_cloud(60000, 3, 2);
  const Scenes whole{flat_scene(cloud)},
      halves{flat_scene(part_of(cloud, 0, 25000)), flat_scene(part_of(cloud, 25000, cloud.size()))},
      baked{baked_scene(part_of(cloud, 0, 25000)), halves[1]};
  for (const FrameInput& input : varied_frames()) {
    for (const NamedDesc& named : all_exponentials(std::array{32u})) {
      SCOPED_TRACE(named.name);
      expect_same_bits(draw_all(whole, named.desc, input), draw_all(halves, named.desc, input));
    }
    expect_same_bits(draw_all(whole, {}, input), draw_all(baked, {.lod = Lod::all_leaves}, input));
    const PipelineDesc base{.splatting = Splatting::baseline_3dgs};
    expect_same_bits(draw_all(whole, base, input), draw_all(halves, base, input));
  }
}

TEST_F(SplatInstances, APoseThatIsTheIdentityChangesNoBit) {
  const Scenes scene{baked_scene(random_cloud(20000, 4, 2))};
  for (const Splatting splatting : kSplattings) {
    const PipelineDesc desc{.splatting = splatting};
    const auto one = view_of(*cuda, scene, desc), other = view_of(*cuda, scene, desc);
    for (const FrameInput& input : varied_frames()) {
      FrameInput posed = input;
      posed.instances = {InstancePose{}};
      expect_same_bits(render(*one, input), render(*other, posed));
    }
  }
}

TEST_F(SplatInstances, PosedInstancesAreWhatTheOthersDraw) {
  const auto tree = baked_scene(random_cloud(8000, 5, 3)),
             small = baked_scene(random_cloud(900, 6, 1));
  const std::shared_ptr<const Scene> flat = flat_scene(random_cloud(3000, 7, 2)),
                                     empty = empty_scene();
  const Scenes scenes{empty, tree, flat, small, tree};
  Agreement against_cpu("instances, CUDA against the CPU"),
      against_reference("instances, CUDA against the reference");
  const auto own = view_of(*cuda, scenes), host = view_of(*cpu, scenes),
             judge = view_of(*reference, scenes);
  double turn = 0;
  for (FrameInput input : varied_frames()) {
    turn += 25;
    input.instances = {pose_of({0, 0, 0}), pose_of({2, 0, 1}, turn), pose_of({-3, 1, 0}, 40, 0.5),
                       pose_of({0, 4, 2}, 2 * turn, 1.7), pose_of({9, 0, 6})};
    const Frame found = render(*own, input);
    against_cpu.add(found, render(*host, input));
    against_reference.add(found, render(*judge, input));
    for (size_t i = 0; i < scenes.size(); ++i) EXPECT_EQ(cut_of(*own, i), cut_of(*host, i)) << i;
    EXPECT_EQ(found.stats.cut_size, host->stats().cut_size);
    EXPECT_EQ(found.stats.nodes_total, host->stats().nodes_total);
    EXPECT_EQ(found.stats.entered, host->stats().entered);
    EXPECT_EQ(found.stats.left, host->stats().left);
    expect_same_bits(found, draw_all(scenes, {}, input));
  }
  against_cpu.expect();
  against_reference.expect();
}

TEST_F(SplatInstances, FadedAndClippedOnesAreWhatTheOthersDraw) {
  const auto tree = baked_scene(random_cloud(8000, 5, 3)),
             compact = baked_scene(random_cloud(5000, 6, 1), Quality::compact);
  const std::shared_ptr<const Scene> flat = flat_scene(random_cloud(3000, 7, 2));
  const Scenes scenes{tree, flat, compact, tree};
  Agreement against_cpu("looks, CUDA against the CPU"),
      against_reference("looks, CUDA against the reference");
  const auto own = view_of(*cuda, scenes), host = view_of(*cpu, scenes),
             judge = view_of(*reference, scenes);
  for (FrameInput input : varied_frames()) {
    input.instances = {pose_of({0, 0, 0}), pose_of({2, 0, 1}, 30), pose_of({-3, 1, 0}, 40, 0.8),
                       pose_of({0, 4, 2}, 50, 1.2)};
    input.looks = {{0.4f, kNoClip},
                   {1, {{-2, -1, -kNoLimit}, {3, kNoLimit, kNoLimit}}},
                   {0.8f, {{-kNoLimit, -2, -3}, {kNoLimit, 2, 3}}},
                   {0, kNoClip}};
    const Frame found = render(*own, input);
    against_cpu.add(found, render(*host, input));
    against_reference.add(found, render(*judge, input));
    expect_same_bits(found, draw_all(scenes, {}, input));
  }
  against_cpu.expect();
  against_reference.expect();
}

// To the bit: a box of a flat scene against the scene of what is inside, opacity 1 and no box
// against nothing said, opacity 0 against the others alone. With either splatting, one eye or two,
// and whether or not tiles hide.
TEST_F(SplatInstances, LooksThatChangeNothingChangeNoBit) {
  const GaussianCloud cloud = random_cloud(20000, 8, 2);
  const std::shared_ptr<const Scene> flat = flat_scene(cloud), tree = baked_scene(cloud);
  const ClipBox<double> box{{-3, -kNoLimit, -2}, {4, 2, kNoLimit}};
  const auto inside = flat_scene(cloud);
  size_t kept = 0;
  const size_t each = 3 * static_cast<size_t>(inside->coefficients());
  for (size_t i = 0; i < cloud.size(); ++i) {
    if (!is_inside(local_clip(box, inside->origin), inside->gaussians[i].mean)) continue;
    inside->gaussians[kept] = inside->gaussians[i];
    for (size_t k = 0; k < each; ++k) inside->sh[kept * each + k] = inside->sh[i * each + k];
    ++kept;
  }
  inside->gaussians.resize(kept), inside->sh.resize(kept * each);
  ASSERT_LT(kept, cloud.size());
  for (const PipelineDesc& desc :
       {PipelineDesc{.occlusion = Occlusion::off}, PipelineDesc{.occlusion = Occlusion::on},
        PipelineDesc{.splatting = Splatting::baseline_3dgs}}) {
    const auto clipped = view_of(*cuda, {flat}, desc), made = view_of(*cuda, {inside}, desc),
               two = view_of(*cuda, {tree, flat}, desc), one = view_of(*cuda, {flat}, desc);
    for (const FrameInput& input : varied_frames()) {
      FrameInput looks = input;
      looks.looks = {{1, box}};
      expect_same_bits(render(*made, input), render(*clipped, looks));
      const Frame plain = render(*two, input);
      looks.looks = {{}, {}};
      expect_same_bits(plain, render(*two, looks));
      looks.looks[0].opacity = 0;
      expect_same_bits(render(*one, input), render(*two, looks));
    }
  }
}

// An instance goes on with its search; what comes is searched anew.
TEST_F(SplatInstances, ListsThatChangeDrawAsViewsMadeOfThem) {
  const auto a = baked_scene(random_cloud(50000, 13, 0)),
             b = baked_scene(random_cloud(3000, 14, 1));
  const std::shared_ptr<const Scene> flat = flat_scene(random_cloud(700, 15, 0));
  const Scenes lists[] = {{a}, {flat, a, b}, {b, a}, {}, {a, a}, {a}};
  for (const PipelineDesc& desc :
       {PipelineDesc{}, PipelineDesc{.search = Search::exhaustive},
        PipelineDesc{.search = Search::fastest}, PipelineDesc{.occlusion = Occlusion::on},
        PipelineDesc{.splatting = Splatting::baseline_3dgs}}) {
    const auto view = view_of(*cuda, {a, b}, desc);
    const FrameInput input = varied_frames()[1];
    render(*view, input);
    const std::vector<uint32_t> of_a = cut_of(*view, 0), of_b = cut_of(*view, 1);
    const uint64_t entered[] = {0, of_b.size(), 0, 0, 2 * of_a.size(), 0};
    for (size_t i = 0; i < std::size(lists); ++i) {
      view->set_scenes(lists[i]);
      const Frame found = render(*view, input);
      EXPECT_EQ(found.stats.entered, entered[i]) << i;
      expect_same_bits(draw_all(lists[i], desc, input), found);
      for (size_t k = 0; k < lists[i].size(); ++k)
        if (lists[i][k] == a) {
          EXPECT_EQ(cut_of(*view, k), of_a) << i;
        }
    }
  }
}

TEST_F(SplatInstances, WhatGoesGivesBackItsMemory) {
  const auto a = baked_scene(random_cloud(20000, 13, 0));
  const FrameInput input = varied_frames()[2];
  const auto view = view_of(*cuda, {a});
  render(*view, input);
  const auto bytes_of = [&](size_t count) {
    view->set_scenes(Scenes(count, a));
    render(*view, input);
    return static_cast<double>(cuda::buffer_bytes);
  };
  const double one = bytes_of(1), eight = bytes_of(8), after = bytes_of(1);
  EXPECT_GT(eight, one);
  EXPECT_LT(after, one + (eight - one) / 4);
}

TEST_F(SplatInstances, APosedInstanceIsTheInverseCameraMove) {
  const Scenes scene{baked_scene(random_cloud(20000, 8, 3))};
  for (const Splatting splatting : kSplattings) {
    const PipelineDesc desc{.splatting = splatting};
    // Boxes of the baseline are whole pixels: one may fall to the other side of a tile.
    const double least = splatting == Splatting::ours ? 60 : 50;
    for (const FrameInput& input : varied_frames())
      for (const InstancePose& pose : {pose_of({0, 0, 0}, 100), pose_of({100, 50, -20}, 77, 3.7)}) {
        const Frame expected = draw_all(scene, desc, input);
        const Frame found = draw_all(scene, desc, seen_posed(input, pose));
        EXPECT_NEAR(static_cast<double>(found.cut.size()), static_cast<double>(expected.cut.size()),
                    1);
        EXPECT_GE(compare(found, expected).psnr, least) << pose.scale;
      }
  }
}

TEST_F(SplatInstances, TheBaselineDrawsThemToo) {
  const Scenes scenes{baked_scene(random_cloud(8000, 9, 1)), flat_scene(random_cloud(4000, 10, 2))};
  for (FrameInput input : varied_frames()) {
    input.instances = {pose_of({1, 0, 0}, 30), pose_of({0, 2, 0}, 60, 1.4)};
    const Frame base = draw_all(scenes, {.splatting = Splatting::baseline_3dgs}, input);
    expect_no_nan(base);
    EXPECT_GE(compare(base, draw_all(scenes, {}, input)).psnr, 30);
  }
}

// The lists of all instances are longer than the room that buffers begin with, and that of
// each is not.
TEST_F(SplatInstances, BuffersGrowWithAllOfThem) {
  const Scenes scenes(3, flat_scene(random_cloud(150000, 11, 0)));
  FrameInput input = varied_frames()[1];
  input.instances = {pose_of({0, 0, 0}), pose_of({1, 0, 0}, 90), pose_of({0, 1, 0}, 200)};
  const auto one = view_of(*cuda, scenes);
  const Frame first = render(*one, input);
  EXPECT_EQ(first.stats.pairs_dropped, 0u);
  EXPECT_EQ(first.stats.cut_size, 450000u);
  expect_same_bits(first, render(*one, input));
  EXPECT_GE(compare(first, render(*view_of(*cpu, scenes), input)).psnr, 60);
}

TEST_F(SplatInstances, DepthsThatTieGoByInstance) {
  const auto red = empty_scene(), green = empty_scene();
  add_gaussian(*red, {0, 0, 4}, {2, 2, 0.01f}, 0.9f, {1, 0, 0});
  add_gaussian(*green, {0, 0, 4}, {2, 2, 0.01f}, 0.9f, {0, 1, 0});
  const FrameInput input = frame_input(look({0, 0, 0}, {0, 0, 1}, 16, 16));
  for (const Splatting splatting : kSplattings) {
    const Frame red_first = draw_all({red, green}, {.splatting = splatting}, input),
                green_first = draw_all({green, red}, {.splatting = splatting}, input);
    EXPECT_GT(red_first.at(8, 8)[0], 5 * red_first.at(8, 8)[1]);
    EXPECT_GT(green_first.at(8, 8)[1], 5 * green_first.at(8, 8)[0]);
  }
}

// However often it is drawn, a scene is on the device once.
TEST_F(SplatInstances, OneSceneIsUploadedOnce) {
  const std::shared_ptr<const Scene> scene = flat_scene(random_cloud(500000, 12, 3));
  const auto made_by = [&](size_t instances) {
    const size_t before = cuda::buffer_bytes;
    const auto made = view_of(*cuda, Scenes(instances, scene));
    return cuda::buffer_bytes - before;
  };
  made_by(1);  // what a first view sets up
  const size_t one = made_by(1), eight = made_by(8);
  EXPECT_GT(one, size_t{500000} * 48);
  EXPECT_LT(eight, one + one / 2);
}

TEST_F(SplatInstances, ADamagedChunkFailsTheFramesThatNeedIt) {
  const Bytes bytes = scene_bytes(bake(random_cloud(6000, 4, 1)), Quality::lossless, 0, 32768);
  const SceneFile file(source_of(bytes));
  const ChunkEntry& chunk = file.chunks().back();
  const auto damaged = load_scene(
      std::make_shared<FlippedSource>(bytes, chunk.offset + chunk.bytes / 3, std::byte{4}),
      std::pmr::get_default_resource(), workers);
  const Scenes scenes{baked_scene(random_cloud(2000, 18, 1)), damaged};
  FrameInput good = frame_input(look({3, -6, -50}, {0, 0, 0}, 60, 40), 9);
  good.instances = {InstancePose{}, pose_of({0, 0, 1e7})};
  FrameInput bad = good;
  bad.instances[1] = InstancePose{};
  bad.tau = 0, bad.eyes[0].camera = look({0, 1, 0}, {1, 0, 0}, 60, 40);
  const auto view = view_of(*cuda, scenes);
  const Frame before = render(*view, good);
  GuardedImage image(ColorFormat::rgba8, 60, 40);
  EXPECT_EQ(error_code([&] { view->render(bad, image.image()); }), ErrorCode::damaged_chunk);
  EXPECT_TRUE(image.untouched());
  expect_same_bits(before, render(*view, good));
}

}  // namespace
}  // namespace splat_instances_test
}  // namespace voyager::test
