// Several scenes in one view: what each is drawn as, and that they are one picture.
#include "tests/support/instances.h"
#include "runtime/base/error.h"
#include "runtime/scene/append.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_rules.h"

namespace voyager::instances_test {
namespace {

using test::compare;
using test::cut_of;
using test::expect_same_bits;
using test::Frame;
using test::frame_input;
using test::look;
using test::pose_of;
using test::render;
using test::seen_posed;

class Instances : public ::testing::Test {
 protected:
  View view(Backend& backend, const Scenes& scenes, const PipelineDesc& desc = {}) {
    return View(scenes, backend, desc, std::pmr::get_default_resource(), workers);
  }

  Workers workers{2};
  const std::unique_ptr<Backend> cpu = create_cpu_backend(), reference = create_reference_backend();
  const std::unique_ptr<Backend>* const backends[2] = {&cpu, &reference};
};

const FrameInput kOutside = frame_input(look({3, -6, -24}, {0.1, 0.2, 5}, 133, 77)),
                 kInside = frame_input(look({1, 1, 1}, {5, 2, 9}, 64, 70, 110), 6);

// The halves fill the same space, so that their splats alternate in depth.
TEST_F(Instances, HalvesThatOverlapAreTheWholeSceneToTheBit) {
  const GaussianCloud cloud = test::random_cloud(6000, 3, 2);
  const Scenes whole{test::flat_scene(cloud)},
      halves{test::flat_scene(test::part_of(cloud, 0, 2500)),
             test::flat_scene(test::part_of(cloud, 2500, cloud.size()))},
      baked{test::baked_scene(test::part_of(cloud, 0, 2500)), halves[1]};
  for (const auto* backend : backends)
    for (const FrameInput& input : {kOutside, kInside}) {
      const Frame expected = render(**backend, whole, {}, input);
      expect_same_bits(expected, render(**backend, halves, {}, input));
      expect_same_bits(expected, render(**backend, baked, {.lod = Lod::all_leaves}, input));
      EXPECT_GT(compare(expected, render(**backend, {halves[0]}, {}, input)).largest, 0.1);
    }
}

// The root keeps the halves apart, so the trees are the same but for their tops, which these
// cuts are below.
TEST_F(Instances, TreesOfTheHalvesGiveTheWholeTreesCutAndPicture) {
  constexpr size_t kHalf = 8192;
  const GaussianCloud cloud = test::two_clusters(kHalf, 1);
  const auto baked = [](const GaussianCloud& part) {  // of blocks that no cluster shares
    return test::baked_scene(part, Quality::lossless, test::kSmallBlocks);
  };
  const Scenes whole{baked(cloud)},
      halves{baked(test::part_of(cloud, 0, kHalf)), baked(test::part_of(cloud, kHalf, 2 * kHalf))};
  View one = view(*cpu, whole), two = view(*cpu, halves);
  for (const double tau : {0.0, 1.0, 3.0, 9.0}) {
    const FrameInput input = frame_input(look({3, -6, -34}, {0.1, 0.2, 5}, 240, 160), tau);
    const Frame expected = render(one, input), found = render(two, input);
    ASSERT_GT(expected.cut.size(), 100u);
    EXPECT_EQ(found.stats.cut_size, expected.stats.cut_size);
    EXPECT_EQ(cut_of(two, 0).size() + cut_of(two, 1).size(), expected.cut.size());
    EXPECT_LE(compare(expected, found).largest, 1.0 / 255) << tau;
  }
}

TEST_F(Instances, APosedInstanceIsTheInverseCameraMove) {
  const Scenes baked{test::baked_scene(test::random_cloud(5000, 7, 3))},
      flat{test::flat_scene(test::random_cloud(3000, 8, 3))};
  for (const auto* backend : backends)
    for (const Scenes& scenes : {baked, flat})
      for (const InstancePose& pose :
           {pose_of({7, -3, 2}), pose_of({0, 0, 0}, 100), pose_of({100, 50, -20}, 77, 3.7),
            pose_of({-1e3, 2e3, 5}, 200, 0.013), pose_of({0, 0, 0}, 0, 2)})
        for (const FrameInput& input : {kOutside, kInside}) {
          const Frame expected = render(**backend, scenes, {}, input);
          const Frame found = render(**backend, scenes, {}, seen_posed(input, pose));
          EXPECT_GE(compare(expected, found).psnr, 60) << pose.scale;
          EXPECT_NEAR(static_cast<double>(found.cut.size()),
                      static_cast<double>(expected.cut.size()), 1);
          size_t steps = 0;
          for (size_t i = 0; i < expected.depth.size(); ++i) {
            const auto depth = static_cast<double>(expected.depth[i]) * pose.scale;
            const auto other = static_cast<double>(found.depth[i]);
            steps += !(other == depth || std::fabs(other - depth) < 1e-4 * depth);
          }
          EXPECT_LE(steps, expected.depth.size() / 1000);
        }
}

// By other means: the Gaussians themselves are moved. (SH coefficients would have to be turned,
// too: degree 0 has nothing to turn.)
TEST_F(Instances, APosedInstanceIsTheSceneWithItsGaussiansMoved) {
  const InstancePose pose = pose_of({4, -2, 9}, 0, 1.5);
  const Quatd turn{0.8, 0.36, -0.288, 0.384};
  const InstancePose turned{rotation(normalise(turn)), pose.position, pose.scale};
  const auto scene = test::flat_scene(test::random_cloud(4000, 9, 0));
  const auto moved = test::flat_scene(test::random_cloud(4000, 9, 0));
  moved->native.pixel *= 1.5;
  for (Gaussian& g : moved->gaussians) {
    const Vec3d mean = test::to_world(turned, {g.mean.x, g.mean.y, g.mean.z});
    const Quatd q = normalise(turn) * Quatd{g.rotation.w, g.rotation.x, g.rotation.y, g.rotation.z};
    for (int i = 0; i < 3; ++i) g.mean[i] = static_cast<float>(mean[i]), g.scale[i] *= 1.5f;
    g.rotation = {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
                  static_cast<float>(q.z)};
  }
  const FrameInput plain = frame_input(look({3, -6, -24}, {4, -2, 9}, 133, 77));
  FrameInput posed = plain;
  posed.instances = {turned};
  for (const auto* backend : backends) {
    const Frame expected = render(**backend, Scenes{moved}, {}, plain);
    EXPECT_GE(compare(expected, render(**backend, Scenes{scene}, {}, posed)).psnr, 60);
    EXPECT_LT(compare(expected, render(**backend, Scenes{scene}, {}, plain)).psnr, 40);
  }
}

TEST_F(Instances, OneSceneTwiceIsTheSceneAndItsCopyInOne) {
  GaussianCloud cloud = test::random_cloud(2000, 10, 0), both = test::random_cloud(2000, 10, 0);
  const Scenes twice(2, test::flat_scene(cloud));
  for (size_t i = 0; i < cloud.position.size(); ++i) cloud.position[i] += i % 3 == 0 ? 2.0f : 0.0f;
  append(both, std::move(cloud), "the copy");
  FrameInput input = kOutside;
  input.instances = {InstancePose{}, pose_of({2, 0, 0})};
  for (const auto* backend : backends)
    EXPECT_GE(compare(render(**backend, twice, {}, input),
                      render(**backend, Scenes{test::flat_scene(both)}, {}, kOutside))
                  .psnr,
              60);
}

TEST_F(Instances, DepthsThatTieGoByInstance) {
  const auto red = test::empty_scene(), green = test::empty_scene();
  test::add_gaussian(*red, {0, 0, 4}, {2, 2, 0.01f}, 0.9f, {1, 0, 0});
  test::add_gaussian(*green, {0, 0, 4}, {2, 2, 0.01f}, 0.9f, {0, 1, 0});
  const FrameInput input = frame_input(look({0, 0, 0}, {0, 0, 1}, 16, 16));
  for (const auto* backend : backends) {
    const Frame red_first = render(**backend, {red, green}, {}, input),
                green_first = render(**backend, {green, red}, {}, input);
    EXPECT_GT(red_first.at(8, 8)[0], 5 * red_first.at(8, 8)[1]);
    EXPECT_GT(green_first.at(8, 8)[1], 5 * green_first.at(8, 8)[0]);
  }
}

// A pose of each instance, not of the first; and the nearer hides the farther, whatever their
// order in the view.
TEST_F(Instances, TheNearerHidesTheFarther) {
  const auto red = test::empty_scene(), green = test::empty_scene();
  test::add_gaussian(*red, {0, 0, 4}, {2, 2, 0.01f}, 0.9f, {1, 0, 0});
  test::add_gaussian(*green, {0, 0, 4}, {2, 2, 0.01f}, 0.9f, {0, 1, 0});
  FrameInput input = frame_input(look({0, 0, 0}, {0, 0, 1}, 16, 16));
  for (const auto* backend : backends)
    for (const bool swapped : {false, true}) {
      // Green comes to be at z = 3, of half the size.
      input.instances = {pose_of({0, 0, 0}), pose_of({0, 0, 1}, 0, 0.5)};
      Scenes scenes{red, green};
      if (swapped) {
        std::swap(scenes[0], scenes[1]);
        std::swap(input.instances[0], input.instances[1]);
      }
      const Frame frame = render(**backend, scenes, {}, input);
      EXPECT_GT(frame.at(8, 8)[1], 5 * frame.at(8, 8)[0]) << swapped;
      EXPECT_NEAR(static_cast<double>(frame.depth[8 * 16 + 8]), 3.0, 1e-6);
    }
}

TEST_F(Instances, WhatShowsNothingChangesNoBit) {
  const auto scene = test::baked_scene(test::random_cloud(9000, 11, 1)),
             other = test::baked_scene(test::random_cloud(500, 12, 3));
  const std::shared_ptr<const Scene> empty = test::empty_scene();
  FrameInput input = kOutside;
  input.instances = {pose_of({0, 0, 0}), pose_of({0, 0, 0}), pose_of({0, 0, -1e4}, 40, 3)};
  for (const auto* backend : backends) {
    const Frame expected = render(**backend, {scene}, {}, kOutside);
    FrameInput identity = kOutside;
    identity.instances = {InstancePose{}};
    expect_same_bits(expected, render(**backend, {scene}, {}, identity));
    expect_same_bits(expected, render(**backend, {empty, scene, other}, {}, input));
    std::swap(input.instances[1], input.instances[2]);
    expect_same_bits(expected, render(**backend, {scene, other, empty}, {}, input));
    std::swap(input.instances[1], input.instances[2]);
  }
}

TEST_F(Instances, EachHasTheCutThatItHasByItself) {
  const auto a = test::baked_scene(test::random_cloud(5000, 13, 0)),
             b = test::baked_scene(test::random_cloud(3000, 14, 1));
  const std::shared_ptr<const Scene> flat = test::flat_scene(test::random_cloud(700, 15, 0));
  for (const Search search : {Search::exhaustive, Search::streaming, Search::temporal}) {
    const PipelineDesc desc{.search = search};
    View together = view(*cpu, {flat, a, b, a}, desc);
    View alone[] = {view(*cpu, {flat}, desc), view(*cpu, {a}, desc), view(*cpu, {b}, desc),
                    view(*cpu, {a}, desc)};
    for (int step = 0; step < 12; ++step) {
      FrameInput input =
          frame_input(look({3 + 0.3 * step, -6, -24}, {0.5, 0, 0}, 60, 40), step < 9 ? 10 : 30);
      input.instances = {pose_of({0, 0, 0}), pose_of({9, 0, 0}, 10.0 * step),
                         pose_of({-9, 1, 0}, 20, 1.5), pose_of({0, 0, 0})};
      render(together, input);
      FrameStats sum;
      for (size_t i = 0; i < 4; ++i) {
        FrameInput own = input;
        own.instances = {input.instances[i]};
        const Frame expected = render(alone[i], own);
        EXPECT_EQ(cut_of(together, i), expected.cut) << i;
        sum.nodes_total += expected.stats.nodes_total;
        sum.nodes_tested += expected.stats.nodes_tested;
        sum.cut_size += expected.stats.cut_size;
        sum.entered += expected.stats.entered;
        sum.left += expected.stats.left;
        sum.splats += expected.stats.splats;
      }
      const FrameStats& found = together.stats();
      EXPECT_EQ(found.nodes_total, sum.nodes_total);
      EXPECT_EQ(found.nodes_tested, sum.nodes_tested);
      EXPECT_EQ(found.cut_size, sum.cut_size);
      EXPECT_EQ(found.entered, sum.entered) << step;
      EXPECT_EQ(found.left, sum.left) << step;
      EXPECT_EQ(found.splats, sum.splats);
      EXPECT_EQ(found.search, alone[1].stats().search);
      EXPECT_TRUE(found.searched);
    }
  }
}

// A flat scene whose Gaussians have the opacity, and lack those outside the box.
std::shared_ptr<Scene> made_as(const GaussianCloud& cloud, const InstanceLook& look) {
  const auto scene = test::flat_scene(cloud);
  const ClipBox<float> box = local_clip(look.clip, scene->origin);
  const size_t each = 3 * static_cast<size_t>(scene->coefficients());
  size_t kept = 0;
  for (size_t i = 0; i < scene->gaussians.size(); ++i) {
    Gaussian g = scene->gaussians[i];
    if (!is_inside(box, g.mean)) continue;
    g.opacity *= look.opacity, g.log_opacity += std::log(look.opacity);
    scene->gaussians[kept] = g;
    std::copy_n(scene->sh.begin() + static_cast<std::ptrdiff_t>(i * each), each,
                scene->sh.begin() + static_cast<std::ptrdiff_t>(kept++ * each));
  }
  scene->gaussians.resize(kept), scene->sh.resize(kept * each);
  return scene;
}

TEST_F(Instances, AFadedAndClippedSceneIsOneMadeSo) {
  const GaussianCloud cloud = test::random_cloud(5000, 30, 2);
  const Scenes whole{test::flat_scene(cloud)};
  InstanceLook looks[] = {
      {0.5f, kNoClip}, {1, {{-2, -1, -kNoLimit}, {4, kNoLimit, 3}}}, {0.07f, {}}};
  looks[2].clip = {{-9, -9, -9}, {9, 9, 2}};
  for (const Antialias antialias : {Antialias::on, Antialias::off})
    for (const InstanceLook& look : looks)
      for (FrameInput input : {kOutside, kInside}) {
        const PipelineDesc desc{.antialias = antialias};
        const Scenes made{made_as(cloud, look)};
        ASSERT_LE(made[0]->gaussians.size(), cloud.size());
        const Frame expected = render(*cpu, made, desc, input),
                    judged = render(*reference, made, desc, input);
        input.looks = {look};
        expect_same_bits(expected, render(*cpu, whole, desc, input));
        // The reference multiplies in double what is rounded in the other scene.
        EXPECT_GE(compare(judged, render(*reference, whole, desc, input)).psnr, 100);
      }
}

// Nodes and blended nodes, compact and not.
TEST_F(Instances, FadedAndClippedTreesAgreeWithTheReference) {
  const GaussianCloud cloud = test::random_cloud(3000, 31, 1);
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    const Scenes scenes(2, test::baked_scene(cloud, quality));
    View host = view(*cpu, scenes), judge = view(*reference, scenes);
    for (const double tau : {0.5, 4.0, 12.0}) {
      FrameInput input = kOutside;
      input.tau = tau;
      const Frame plain = render(host, input);
      input.instances = {pose_of({1, 0, 0}, 20), pose_of({-1, 2, 0}, 70, 1.3)};
      input.looks = {{0.45f, {{-3, -kNoLimit, -2}, {2, 1, kNoLimit}}}, {0.8f, kNoClip}};
      const Frame found = render(host, input);
      EXPECT_GE(compare(found, render(judge, input)).psnr, 60) << tau;
      EXPECT_EQ(cut_of(host, 0), cut_of(judge, 0));
      EXPECT_GT(compare(found, plain).largest, 0.1);
      // With 1, 0 and no box: as it is, and not at all.
      input.looks.assign(2, {});
      FrameInput none = input, gone = input;
      none.looks.clear(), gone.looks[0].opacity = 0;
      expect_same_bits(render(host, none), render(host, input));
      const Frame without = render(host, gone);
      FrameInput other = gone;
      other.instances = {gone.instances[1]}, other.looks = {gone.looks[1]};
      expect_same_bits(render(*cpu, Scenes{scenes[1]}, {}, other), without);
    }
  }
}

// An instance goes on with its search, whatever comes, goes and changes its place.
TEST_F(Instances, ListsThatChangeKeepWhatTheirSearchesKnow) {
  const auto a = test::baked_scene(test::random_cloud(5000, 13, 0)),
             b = test::baked_scene(test::random_cloud(3000, 14, 1));
  const std::shared_ptr<const Scene> flat = test::flat_scene(test::random_cloud(700, 15, 0));
  const Scenes lists[] = {{a}, {flat, a, b}, {b, a}, {}, {a, a}, {a}};
  const FrameInput input = frame_input(look({3, -6, -24}, {0.5, 0, 0}, 60, 40), 10);
  for (const auto* backend : backends) {
    View view = this->view(**backend, {a, b});
    render(view, input);
    const std::vector<uint32_t> of_a = cut_of(view, 0), of_b = cut_of(view, 1);
    const uint64_t entered[] = {0, of_b.size(), 0, 0, 2 * of_a.size(), 0};
    for (size_t i = 0; i < std::size(lists); ++i) {
      view.set_scenes(lists[i]);
      EXPECT_FALSE(view.has_cuts());
      const Frame found = render(view, input);
      expect_same_bits(render(**backend, lists[i], {}, input), found);
      EXPECT_EQ(found.stats.entered, entered[i]) << i;
      EXPECT_EQ(found.stats.frame_index, i + 1);
      for (size_t k = 0; k < lists[i].size(); ++k)
        if (lists[i][k] == a) {
          EXPECT_EQ(cut_of(view, k), of_a) << i;
        }
    }
  }
}

TEST_F(Instances, DoNotDependOnThreadsOrEarlierFrames) {
  const Scenes scenes{test::baked_scene(test::random_cloud(12000, 16, 1)),
                      test::flat_scene(test::random_cloud(5000, 17, 2))};
  Workers one(1), five(5);
  View first(scenes, *cpu, {}, std::pmr::get_default_resource(), one),
      other(scenes, *cpu, {}, std::pmr::get_default_resource(), five);
  for (int step = 0; step < 6; ++step) {
    FrameInput input = step % 2 == 0 ? kOutside : kInside;
    input.instances = {pose_of({0, 0, 0}, 15.0 * step), pose_of({1, 2, 3}, 40, 0.7)};
    const Frame expected = render(*cpu, scenes, {}, input);
    expect_same_bits(expected, render(first, input));
    expect_same_bits(expected, render(other, input));
  }
}

// In any of the instances; the view's other frames are as if nothing had been.
TEST_F(Instances, ADamagedChunkFailsTheFramesThatNeedIt) {
  const test::Bytes bytes =
      test::scene_bytes(test::bake(test::random_cloud(6000, 4, 1)), Quality::lossless);
  const SceneFile file(test::source_of(bytes));
  const auto damaged = load_scene(
      std::make_shared<test::FlippedSource>(bytes, file.chunks().back().offset + 200, std::byte{1}),
      std::pmr::get_default_resource(), workers);
  const auto whole = test::baked_scene(test::random_cloud(2000, 18, 1));
  FrameInput good = frame_input(look({3, -6, -50}, {0, 0, 0}, 60, 40), 9);
  good.instances = {InstancePose{}, pose_of({0, 0, 1e7})};  // far: a single node
  FrameInput bad = good;
  bad.instances[1] = InstancePose{};
  bad.tau = 0, bad.eyes[0].camera = look({0, 1, 0}, {1, 0, 0}, 60, 40);
  for (const auto* backend : backends) {
    View view = this->view(**backend, {whole, damaged});
    const Frame before = render(view, good);
    EXPECT_EQ(test::error_code([&] { render(view, bad); }), ErrorCode::damaged_chunk);
    EXPECT_EQ(view.stats().cut_size, before.stats.cut_size);
    const Frame after = render(view, good);
    expect_same_bits(before, after);
    EXPECT_EQ(after.stats.entered + after.stats.left, 0u);
  }
}

TEST_F(Instances, AnEyeBeyondAScenesCoordinatesIsRefused) {
  const std::shared_ptr<const Scene> scene = test::flat_scene(test::random_cloud(10, 19, 0));
  View view = this->view(*cpu, {scene, scene});
  FrameInput input = kOutside;
  input.instances = {InstancePose{}, pose_of({1e10, 0, 0}, 0, 1e-9)};
  try {
    render(view, input);
    FAIL() << "expected a refusal";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
    EXPECT_NE(std::string(error.what())
                  .find("frame.eyes[0].pose.position: found -1e+19 on axis 0 from the scene's "
                        "origin of instance 1"),
              std::string::npos)
        << error.what();
  }
  input.instances[1].scale = 1;
  EXPECT_GT(render(view, input).stats.splats, 0u);
}

// Where origins are far from 0: an instance is turned about the world's zero, not its origin.
TEST_F(Instances, AFarOriginTurnsWithItsScene) {
  GaussianCloud cloud = test::random_cloud(3000, 20, 1);
  const std::shared_ptr<const Scene> near = test::flat_scene(cloud);
  cloud.origin = {6371008, -1024, 2048};
  const std::shared_ptr<const Scene> far = test::flat_scene(cloud);
  // Puts the far scene's origin where the near one's is.
  InstancePose pose = pose_of({0, 0, 0}, 65);
  pose.position = -1.0 * (pose.rotation * Vec3d{6371008, -1024, 2048});
  InstancePose turned = pose;
  turned.position = {0, 0, 0};
  FrameInput expected = kOutside, found = kOutside;
  expected.instances = {turned}, found.instances = {pose};
  for (const auto* backend : backends)
    EXPECT_GE(
        compare(render(**backend, {near}, {}, expected), render(**backend, {far}, {}, found)).psnr,
        60);
}

}  // namespace
}  // namespace voyager::instances_test
