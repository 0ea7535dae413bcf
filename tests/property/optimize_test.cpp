// Nodes that learn: pictures that nothing was learned from come nearer to the truth; leaves and the
// tree's promises stay; neither threads nor stops show.
#include "runtime/optimize/optimize.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "runtime/cpu/cpu_backend.h"
#include "runtime/frame/built_scene.h"
#include "runtime/lod/validate.h"
#include "runtime/optimize/checkpoint.h"
#include "runtime/optimize/learn_scene.h"
#include "runtime/optimize/part.h"
#include "runtime/optimize/training_views.h"
#include "runtime/select/cut.h"
#include "tests/support/baked_city.h"
#include "tests/support/learned_scenes.h"
#include "tests/support/render_scene.h"
#include "tests/support/rounded_tree.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_clouds.h"

namespace voyager::optimize_test {
namespace {

using test::expect_same_leaves;
using test::same_merged;

struct Learned {
  BakedScene scene;
  OptimizeSummary summary;
};
Learned learn(const BakedScene& baked, uint32_t pictures, unsigned threads,
              const std::string& kept) {
  Learned learned{baked, {}};
  Workers workers(threads);
  const auto backend = create_cpu_backend();
  learned.summary =
      optimize_nodes(learned.scene, {.pictures = pictures, .held_out = 4}, *backend, kept, workers);
  return learned;
}

// 60 × 33 pixels.
TrainingView small_view(const TrainingViews& views, uint32_t k, double tau) {
  TrainingView view = views(k);
  Camera& c = view.camera;
  c.width /= 4, c.height /= 4;
  c.fx /= 4, c.fy /= 4, c.cx /= 4, c.cy /= 4;
  view.tau = tau;
  view.samples = 4;
  return view;
}

TEST(Optimize, ComesNearerToTheTruthInViewsThatItDidNotLearnFrom) {
  Workers workers;
  const BakedScene baked = test::baked_city(6000);
  const auto backend = create_cpu_backend();
  const auto trainer = backend->create_trainer(scene_of(baked, workers), workers);
  const TrainingViews views(baked, {baked.leaves.size(), 0, 0});
  const auto decibels = [&] {
    double sum = 0;
    for (uint32_t k = 1000; k < 1006; ++k)
      sum -= 10 * std::log10(trainer->error(small_view(views, k, 6)).squares) / 6;
    return sum;
  };
  const double before = decibels();
  constexpr uint32_t kPictures = 160;
  LearningRates rates{0.02f, 0.01f, 0.002f, 0.03f, 0.006f, 0.0006f, 1};
  for (uint32_t k = 0; k < kPictures; ++k) {
    rates.pace = std::pow(0.05f, static_cast<float>(k) / kPictures);
    trainer->step(small_view(views, k, 6), rates);
  }
  EXPECT_GT(decibels(), before + 0.3);
}

// As View draws it: the truth of METHOD §12, and the cut or all leaves, filtered.
std::vector<float> drawn(Backend& backend, const std::shared_ptr<const Scene>& scene,
                         const TrainingView& view, Lod lod, Antialias antialias) {
  PipelineDesc desc;
  desc.lod = lod;
  desc.antialias = antialias;
  const Camera camera = antialias == Antialias::truth ? truth_camera(view) : view.camera;
  const test::Frame frame =
      test::render(backend, scene, desc, test::frame_input(camera, view.tau, false));
  const uint32_t samples = camera.width / view.camera.width;
  std::vector<float> rgb(size_t{3} * view.camera.width * view.camera.height);
  for (size_t y = 0; y < camera.height; ++y)
    for (size_t x = 0; x < camera.width; ++x)
      for (size_t i = 0; i < 3; ++i)
        rgb[3 * (y / samples * view.camera.width + x / samples) + i] +=
            frame.at(x, y)[i] / static_cast<float>(samples * samples);
  return rgb;
}

// The trainer draws by itself what it learns from.
TEST(Optimize, LearnsFromThePicturesThatAreDrawn) {
  Workers workers;
  BakedScene baked = test::bake(test::specks(3000, 6, 1));
  baked.tree = test::rounded(baked.tree);
  const auto backend = create_cpu_backend();
  const auto trainer = backend->create_trainer(scene_of(baked, workers), workers);
  const auto scene = test::loaded(baked);
  const TrainingViews views(baked, {baked.leaves.size(), 0, 0});
  for (uint32_t k = 0; k < 8; ++k) {
    const TrainingView view = small_view(views, k, k % 2 == 0 ? 3 : 12);
    const std::vector<float> truth =
        drawn(*backend, scene, view, Lod::all_leaves, Antialias::truth);
    for (const Lod lod : {Lod::cut, Lod::all_leaves}) {
      const std::vector<float> picture = drawn(*backend, scene, view, lod, Antialias::on);
      double squares = 0;
      for (size_t i = 0; i < picture.size(); ++i)
        squares += (double{picture[i]} - truth[i]) * (double{picture[i]} - truth[i]);
      const double found =
          (lod == Lod::cut ? trainer->error(view) : trainer->error_of_leaves(view)).squares;
      EXPECT_GT(found, 0);
      EXPECT_NEAR(found, squares, 1e-4 * squares) << "view " << k;
    }
  }
}

TEST(Optimize, APictureCountsByTheRootOfItsMeanSquare) {
  TrainingView view;
  view.camera.width = 40, view.camera.height = 30;
  const double values = 3.0 * 40 * 30;
  const auto weight = [&](double mean) { return loss_weight(view, mean * values); };
  EXPECT_NEAR(weight(1e-3) * 1e-3, 1, 1e-9);
  EXPECT_NEAR(weight(4e-3) * 2, weight(1e-3), 1e-9);  // twice the root: half for each square
  EXPECT_EQ(weight(0), weight(1e-7));                 // nothing is weighed without end
}

TEST(Optimize, ATruthIsNotTakenForThatOfAnotherView) {
  Workers workers;
  const BakedScene baked = test::baked_city(300);
  const auto backend = create_cpu_backend();
  const auto scene = scene_of(baked, workers);
  const auto kept = backend->create_trainer(scene, workers);
  const TrainingView one = small_view(TrainingViews(baked, {baked.leaves.size(), 0, 0}), 3, 6);
  TrainingView turned = one, finer = one, smaller = one;
  std::swap(turned.camera.world_to_view.row[0], turned.camera.world_to_view.row[1]);
  finer.samples = 6;
  smaller.camera.width /= 2;
  for (const TrainingView& view : {one, turned, finer, smaller, one})
    EXPECT_EQ(kept->error(view).squares,
              backend->create_trainer(scene, workers)->error(view).squares);
}

TEST(Optimize, NeitherThreadsNorStopsShow) {
  const test::TempFolder folder;
  const BakedScene baked = test::bake(test::specks(1500, 6, 1));
  const BakedScene expected = learn(baked, 8, 1, folder.file("one")).scene;
  EXPECT_FALSE(same_merged(expected, baked));
  EXPECT_TRUE(validate(expected).empty()) << validate(expected).front();
  expect_same_leaves(expected, baked);
  EXPECT_TRUE(same_merged(learn(baked, 8, 4, folder.file("four")).scene, expected));

  struct Stop {};
  const std::string kept = folder.file("stopped");
  for (const uint64_t at : {2, 5}) {
    BakedScene scene = baked;
    Workers workers;
    const auto backend = create_cpu_backend();
    EXPECT_THROW(optimize_nodes(scene, {.pictures = 8, .held_out = 4, .keep_milliseconds = 0},
                                *backend, kept, workers,
                                [&](const char*, uint64_t done, uint64_t) {
                                  if (done == at) throw Stop{};
                                }),
                 Stop);
  }
  EXPECT_TRUE(same_merged(learn(baked, 8, 2, kept).scene, expected));
}

TEST(Optimize, EveryLeafIsDrawnAsBefore) {
  const test::TempFolder folder;
  const BakedScene baked = test::bake(test::specks(300, 6, 1));
  const BakedScene learned = learn(baked, 4, 2, folder.file("kept")).scene;
  EXPECT_FALSE(same_merged(learned, baked));
  const FrameInput input =
      test::frame_input(test::look({3, -6, -24}, {0, 0, 0}, 133, 77), 3, false);
  const auto backend = create_cpu_backend();
  test::expect_same_bits(
      test::render(*backend, test::loaded(learned), {.lod = Lod::all_leaves}, input),
      test::render(*backend, test::loaded(baked), {.lod = Lod::all_leaves}, input));
}

OptimizeSummary learn_in_parts(BakedScene& scene, unsigned threads, const std::string& kept,
                               const Progress& progress = {}, uint32_t held_out = 2) {
  Workers workers(threads);
  const auto backend = create_cpu_backend();
  return optimize_nodes(
      scene,
      {.pictures = 8, .memory = test::kMemoryOfParts, .held_out = held_out, .keep_milliseconds = 0},
      *backend, kept, workers, progress);
}

// A cut that got smaller is no loss where a cut of that size was as good before.
TEST(Optimize, GainsAreThoseWithAsManyGaussians) {
  const auto looked = [](double tau, double cut, double share) {
    return HeldOut{tau, cut, 50, share, {{cut, 50, share}, {cut + 1, 50, share}}};
  };
  OptimizeSummary summary;
  summary.before = {looked(3, 46, 0.8), looked(6, 40, 0.4), looked(15, 30, 0.1)};
  summary.after = {looked(3, 46, 0.8), looked(6, 39, 0.2), looked(15, 31, 0.05)};
  EXPECT_NEAR(summary.least_gain(0), 0, 1e-9);
  EXPECT_NEAR(summary.least_gain(1), 4, 1e-9);  // half way between 30 and 40 in the logarithm
  EXPECT_NEAR(summary.least_gain(2), 1, 1e-9);
  summary.after[0].views[1] = {46.5, 50, 0.8};
  EXPECT_NEAR(summary.least_gain(0), -0.5, 1e-9);
  summary.after[0].views[0] = {47, 50, 1};  // every leaf had 50
  EXPECT_NEAR(summary.least_gain(0), -3, 1e-9);
}

TEST(Optimize, InPartsNeitherThreadsNorStopsShow) {
  const test::TempFolder folder;
  const BakedScene baked = test::bake(test::specks(1500, 6, 1));
  BakedScene expected = baked;
  const OptimizeSummary summary = learn_in_parts(expected, 1, folder.file("one"));
  EXPECT_GT(summary.pictures, 8u);
  for (size_t i = 0; i < summary.after.size(); ++i)
    EXPECT_TRUE(std::isfinite(summary.least_gain(i)));
  ASSERT_GE(kept_files(folder.file("one")).size(), 4u);  // three parts and the top
  EXPECT_EQ(kept_files(folder.file("one"))[1], folder.file("one") + ".1");
  EXPECT_FALSE(same_merged(expected, baked));
  EXPECT_TRUE(validate(expected).empty()) << validate(expected).front();
  expect_same_leaves(expected, baked);

  // All extents shrink by one factor, which is all that held-out views change.
  BakedScene other = baked;
  const OptimizeSummary by_five = learn_in_parts(other, 2, folder.file("five"), {}, 5);
  EXPECT_NE(by_five.shrink, summary.shrink);
  for (size_t n = 0; n < baked.tree.size(); ++n) {
    const auto measured = [n](const BakedScene& scene, double shrink) {
      return double{scene.tree.records[n].extent} / shrink;
    };
    const double extent = measured(expected, summary.shrink);
    EXPECT_NEAR(measured(other, by_five.shrink), extent, 1e-6 * extent) << n;
  }
  for (size_t i = 0; i < summary.after.size(); ++i)
    EXPECT_NEAR(2 * summary.after[i].tau + 1, summary.shrink * (2 * summary.before[i].tau + 1),
                1e-9);

  struct Stop {};
  const std::string kept = folder.file("stopped");
  for (const int at : {3, 11}) {
    BakedScene scene = baked;
    int calls = 0;
    EXPECT_THROW(learn_in_parts(scene, 2, kept,
                                [&](const char*, uint64_t, uint64_t) {
                                  if (++calls == at) throw Stop{};
                                }),
                 Stop);
  }
  BakedScene again = baked;
  learn_in_parts(again, 3, kept);
  EXPECT_TRUE(same_merged(again, expected));

  const std::string foreign = folder.file("foreign");
  std::ofstream(kept_of_part(foreign, 0)) << "my own file, longer than a head";
  EXPECT_THROW(check_checkpoints(foreign), Error);
}

TEST(Optimize, MinutesGiveAsManyPicturesAsThereIsTimeFor) {
  for (const double minutes : {0.5, 5.0, 60.0})
    for (const double each : {1.4, 70.0})
      for (const uint32_t others : {0u, 200u}) {
        const uint32_t learned = pictures_in(minutes, each, others);
        const double measured = measured_with(learned);
        EXPECT_NEAR((learned + measured + others) * each, minutes * 60000, 10 * each);
      }
  EXPECT_EQ(measured_with(600), 9 * 60u);
  EXPECT_EQ(measured_with(2400), 9 * 64u);
  EXPECT_EQ(measured_with(40'000), 9 * 256u);
  EXPECT_EQ(pictures_in(1e-6, 1, 100), 1u);
  EXPECT_EQ(pictures_in(1e9, 1e-3, 0), 1'000'000'000u);
  const test::TempFolder folder;
  BakedScene scene = test::bake(test::specks(300, 7, 0));
  Workers workers;
  const auto backend = create_cpu_backend();
  EXPECT_EQ(optimize_nodes(scene, {.minutes = 1e-6, .held_out = 1}, *backend, folder.file("kept"),
                           workers)
                .pictures,
            1u);
}

TEST(Optimize, LessMemoryThanTheSmallestPartTakesIsRefused) {
  const test::TempFolder folder;
  BakedScene baked = test::bake(test::specks(1500, 6, 1));
  Workers workers;
  const auto backend = create_cpu_backend();
  try {
    optimize_nodes(baked, {.pictures = 8, .memory = 1000}, *backend, folder.file("kept"), workers);
    FAIL() << "nothing was refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::over_budget);
    EXPECT_EQ(
        std::string(error.what()),
        "host memory: found room for 0 Gaussians that learn at once, expected room for 256 at "
        "least");
  }
}

// By node of the tree.
std::vector<bool> cut_of(const LodTree& tree, const CutQuery& query) {
  Workers workers(1);
  ExhaustiveSearch search;
  search.run(tree, {}, query, workers);
  std::vector<bool> cut(tree.size(), false);
  for (const uint32_t n : search.cut()) cut[n] = true;
  return cut;
}

// By node of the part: whether it is below the roots, or one.
std::vector<bool> own_nodes(const ScenePart& part, const PartRoots& roots) {
  std::vector<bool> own(part.whole.size(), false);
  for (uint32_t p = 1; p < own.size(); ++p) {
    const uint32_t parent = part.scene.tree.parent[p];
    own[p] = parent == 0 ? part.whole[p] - roots.first < roots.count : own[parent];
  }
  return own;
}

// What is around a part is in every cut; the rest of its cut is the whole's, but for the roots,
// which have another parent.
TEST(Optimize, APartShowsWhatTheWholeShows) {
  const BakedScene baked = test::baked_city(4000);
  const std::vector<PartRoots> parts = part_roots(baked.tree, 1000);
  ASSERT_GE(parts.size(), 4u);
  for (const PartRoots& roots : parts) {
    const ScenePart part = take_part(baked, roots, 1000);
    const LodTree& tree = part.scene.tree;
    EXPECT_LE(roots.leaves, 1000u);
    EXPECT_EQ(part.own_leaves, roots.leaves);
    EXPECT_GT(part.scene.leaves.size(), roots.leaves);
    EXPECT_LE(part.scene.leaves.size(), roots.leaves + 1000);
    const std::vector<bool> own = own_nodes(part, roots);
    for (const float target : {0.002f, 0.02f, 0.2f}) {
      const CutQuery query{{10, -20, 5}, target};
      const std::vector<bool> cut = cut_of(tree, query), whole = cut_of(baked.tree, query);
      EXPECT_FALSE(cut[0]);
      for (uint32_t p = 1; p < own.size(); ++p) {
        const bool expected = !own[p] || (tree.parent[p] == 0 ? cut[p] : whole[part.whole[p]]);
        ASSERT_EQ(cut[p], expected) << p;
      }
    }
  }
}

// All that merges is in one part, or above them.
TEST(Optimize, PartsHaveEveryMergedNodeOnce) {
  const LodTree tree = test::baked_city(4000).tree;
  std::vector<int> parts_with(tree.size(), 0);
  for (const PartRoots& roots : part_roots(tree, 1000))
    for (uint32_t n = roots.first; n < roots.first + roots.count; ++n) ++parts_with[n];
  std::vector<bool> has_part(tree.size(), false);  // below it
  for (auto n = static_cast<uint32_t>(tree.size()); n-- > 1;)
    if (parts_with[n] != 0 || has_part[n]) has_part[tree.parent[n]] = true;
  for (uint32_t n = 1; n < tree.size(); ++n) {
    const int above = parts_with[tree.parent[n]];
    parts_with[n] += above;
    EXPECT_LE(parts_with[n], 1) << n;
    if (!tree.is_leaf(n)) {
      EXPECT_TRUE(parts_with[n] == 1 || has_part[n]) << n;
    }
  }
}

TEST(Optimize, TheMarkTellsScenesCamerasAndDevicesApart) {
  const BakedScene baked = test::bake(test::specks(300, 7, 1));
  const uint64_t mark = mark_of(baked, {}, "device");
  EXPECT_EQ(mark_of(BakedScene(baked), {}, "device"), mark);
  const TrainingCamera camera{};
  EXPECT_NE(mark_of(baked, {&camera, 1}, "device"), mark);
  EXPECT_NE(mark_of(baked, {}, "another"), mark);
  const auto changed = [&](const auto& change) {
    BakedScene other = baked;
    change(other);
    return mark_of(other, {}, "device");
  };
  EXPECT_NE(changed([](BakedScene& s) { s.tree.records[0].extent *= 2; }), mark);
  EXPECT_NE(changed([](BakedScene& s) { s.node_code.back() ^= 1; }), mark);
  EXPECT_NE(changed([](BakedScene& s) { s.leaves.native.pixel *= 2; }), mark);
  EXPECT_NE(changed([](BakedScene& s) { s.leaves.native.low_pass *= 2; }), mark);
  for (GaussianCloud BakedScene::*cloud : {&BakedScene::leaves, &BakedScene::merged})
    for (auto GaussianCloud::*values :
         {&GaussianCloud::position, &GaussianCloud::log_scale, &GaussianCloud::rotation,
          &GaussianCloud::opacity, &GaussianCloud::sh})
      EXPECT_NE(changed([&](BakedScene& s) { (s.*cloud.*values)[1] += 0.5f; }), mark);
}

TEST(Optimize, WhatWasLearnedOfSomethingElseOrWasAlteredIsRefused) {
  const test::TempFolder folder;
  const std::string kept = folder.file("kept");
  const BakedScene baked = test::bake(test::specks(300, 7, 0));
  struct Stop {};
  const auto run = [&](const BakedScene& scene, OptimizeGoal goal, bool stops) {
    Workers workers;
    const auto backend = create_cpu_backend();
    BakedScene copy = scene;
    goal.held_out = 1;
    goal.keep_milliseconds = 0;
    optimize_nodes(copy, goal, *backend, kept, workers, [&](const char*, uint64_t done, uint64_t) {
      if (stops && done == 1) throw Stop{};
    });
  };
  const auto refusal = [&](const BakedScene& scene, const OptimizeGoal& goal) {
    try {
      run(scene, goal, false);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::refused_input);
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const std::string found = kept + ": found what is learned ",
                    end = ": ask for the same, or remove it";
  EXPECT_THROW(run(baked, {.pictures = 5}, true), Stop);
  EXPECT_EQ(refusal(baked, {.pictures = 6}),
            found + "from 5 pictures, expected from 6 pictures" + end);
  EXPECT_EQ(refusal(baked, {.minutes = 2.5}),
            found + "from 5 pictures, expected in 2.5 minutes" + end);
  EXPECT_EQ(refusal(test::bake(test::specks(300, 8, 0)), {.pictures = 5}),
            kept +
                ": found what was learned of another scene, by another device, with other "
                "--training-cameras or another --memory, expected this one: remove it, and "
                "those of other parts, and learning starts anew");
  std::fstream file(kept, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(60);
  file.put('\x5a');
  file.close();
  const std::string altered = refusal(baked, {.pictures = 5});
  EXPECT_TRUE(altered.starts_with(kept + ": found checksum ")) << altered;
  EXPECT_TRUE(altered.ends_with(": remove it, and learning starts anew")) << altered;
}

}  // namespace
}  // namespace voyager::optimize_test
