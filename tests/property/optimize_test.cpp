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
#include "runtime/optimize/training_views.h"
#include "runtime/scene/append.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_clouds.h"
#include "tools/synth/city.h"

namespace voyager::optimize_test {
namespace {

BakedScene city(uint64_t gaussians) {
  GaussianCloud all;
  synth::generate_city(
      {.gaussians = gaussians, .seed = 7, .sh_degree = 0},
      [&](const GaussianCloud& part) { append(all, GaussianCloud(part), "city"); });
  return test::bake(all);
}

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

bool same(const BakedScene& a, const BakedScene& b) {
  const auto& [x, y] = std::tie(a.merged, b.merged);
  return x.position == y.position && x.log_scale == y.log_scale && x.rotation == y.rotation &&
         x.opacity == y.opacity && x.sh == y.sh && a.node_code == b.node_code &&
         std::equal(a.tree.records.begin(), a.tree.records.end(), b.tree.records.begin(),
                    [](const NodeRecord& r, const NodeRecord& s) { return r.extent == s.extent; });
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
  const BakedScene baked = city(6000);
  const auto backend = create_cpu_backend();
  const auto trainer = backend->create_trainer(scene_of(baked, workers), workers);
  const TrainingViews views(baked);
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

TEST(Optimize, FourCutsOfAViewShareItsTruth) {
  const BakedScene baked = city(200);
  const TrainingViews views(baked);
  for (uint32_t k = 0; k < 12; ++k) {
    const TrainingView found = views.picture(k);
    EXPECT_EQ(truth_of(found), truth_of(views(k / 4)));
    EXPECT_GE(found.tau, 0.75);
    EXPECT_LE(found.tau, 15);
    if (k % 4 != 0) {
      EXPECT_GT(found.tau, views.picture(k - 1).tau);
    }
  }
}

TEST(Optimize, ATruthIsNotTakenForThatOfAnotherView) {
  Workers workers;
  const BakedScene baked = city(300);
  const auto backend = create_cpu_backend();
  const auto scene = scene_of(baked, workers);
  const auto kept = backend->create_trainer(scene, workers);
  const TrainingView one = small_view(TrainingViews(baked), 3, 6);
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
  EXPECT_FALSE(same(expected, baked));
  EXPECT_TRUE(validate(expected).empty()) << validate(expected).front();
  EXPECT_EQ(expected.leaves.position, baked.leaves.position);
  EXPECT_EQ(expected.leaves.opacity, baked.leaves.opacity);
  EXPECT_EQ(expected.leaves.sh, baked.leaves.sh);
  EXPECT_TRUE(same(learn(baked, 8, 4, folder.file("four")).scene, expected));

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
  EXPECT_TRUE(same(learn(baked, 8, 2, kept).scene, expected));
}

TEST(Optimize, WhatWasLearnedOfAnotherSceneOrWasAlteredIsRefused) {
  const test::TempFolder folder;
  const std::string kept = folder.file("kept");
  const BakedScene baked = test::bake(test::specks(300, 7, 0));
  Checkpoint checkpoint;
  checkpoint.pictures = 5;
  checkpoint.extents.resize(baked.tree.size());
  write_checkpoint(checkpoint, mark_of(baked), kept);
  const auto refusal = [&](const BakedScene& scene, uint32_t pictures) {
    try {
      learn(scene, pictures, 1, kept);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::refused_input);
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_EQ(refusal(test::bake(test::specks(300, 8, 0)), 5),
            kept +
                ": found what was learned of another scene, expected this one: remove it, and "
                "learning starts anew");
  EXPECT_EQ(refusal(baked, 6), kept +
                                   ": found what is learned from 5 pictures, expected 6: ask for "
                                   "as many, or remove it");
  std::fstream file(kept, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(40);
  file.put('\x5a');
  file.close();
  const std::string altered = refusal(baked, 5);
  EXPECT_TRUE(altered.starts_with(kept + ": found checksum ")) << altered;
  EXPECT_TRUE(altered.ends_with(": remove it, and learning starts anew")) << altered;
}

}  // namespace
}  // namespace voyager::optimize_test
