// What is learned on the device: as the CPU learns it, to a rounding, and the same bits each time.
#include "runtime/frame/built_scene.h"
#include "runtime/frame/node_trainer.h"
#include "runtime/optimize/training_views.h"
#include "tests/gpu/splat_test.h"
#include "tests/support/mixed_footprints.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_clouds.h"

namespace voyager::test {
namespace train_test {
namespace {

constexpr LearningRates kRates{0.02f, 0.01f, 0.002f, 0.03f, 0.006f, 0.0006f, 1};

class Train : public SplatTest {
 protected:
  // First moments are a tenth of what the loss changes with a step.
  TrainingState learned(Backend& backend, const BakedScene& baked, uint32_t steps, double tau) {
    const auto trainer = backend.create_trainer(scene_of(baked, workers), workers);
    const TrainingViews views(baked, {baked.leaves.size(), 0, 0});
    for (uint32_t k = 0; k < steps; ++k) {
      TrainingView view = views.picture(k);
      view.tau = tau;
      trainer->step(view, kRates);
    }
    return trainer->state();
  }
};

TEST_F(Train, GradientsAreTheCpus) {
  const std::pair<double, BakedScene> cases[] = {
      {10, bake(specks(3000, 5, 3))},
      {8, bake_by_cameras(random_cloud(3000, 4, 2), close_camera())}};
  for (const auto& [tau, baked] : cases) {
    const TrainingState host = learned(*cpu, baked, 1, tau), device = learned(*cuda, baked, 1, tau);
    ASSERT_EQ(host.first.size(), device.first.size());
    const auto numbers = static_cast<size_t>(numbers_of(baked.leaves.sh_degree));
    for (size_t number = 0; number < numbers; ++number) {
      double off = 0, all = 0;
      for (size_t i = number; i < host.first.size(); i += numbers) {
        off += std::fabs(double{host.first[i]} - double{device.first[i]});
        all += std::fabs(double{host.first[i]});
      }
      EXPECT_GT(all, 0) << number;
      EXPECT_LE(off, 1e-3 * all) << "number " << number << ", tau " << tau;
    }
  }
}

TEST_F(Train, TheSameBitsEachTime) {
  const BakedScene baked = bake(specks(3000, 5, 1));
  const TrainingState first = learned(*cuda, baked, 6, 4);
  EXPECT_TRUE(learned(*cuda, baked, 6, 4) == first);
}

TEST_F(Train, GoesOnFromAStateAsIfItHadNotStopped) {
  const BakedScene baked = bake(specks(3000, 5, 1));
  const auto scene = scene_of(baked, workers);
  const TrainingViews views(baked, {baked.leaves.size(), 0, 0});
  const auto whole = cuda->create_trainer(scene, workers),
             stopped = cuda->create_trainer(scene, workers),
             resumed = cuda->create_trainer(scene, workers);
  for (uint32_t k = 0; k < 8; ++k) whole->step(views.picture(k), kRates);
  for (uint32_t k = 0; k < 6; ++k) stopped->step(views.picture(k), kRates);
  resumed->set_state(stopped->state());
  for (uint32_t k = 6; k < 8; ++k) resumed->step(views.picture(k), kRates);
  EXPECT_TRUE(resumed->state() == whole->state());
}

TEST_F(Train, ErrorsOfLeavesAndCutsAreTheCpus) {
  const BakedScene baked = bake(specks(5000, 6, 2));
  const auto scene = scene_of(baked, workers);
  const auto host = cpu->create_trainer(scene, workers),
             device = cuda->create_trainer(scene, workers);
  const TrainingViews views(baked, {baked.leaves.size(), 0, 0});
  for (uint32_t k = 0; k < 3; ++k) {
    const double leaves = host->error_of_leaves(views.picture(5 * k)).squares;
    EXPECT_NEAR(device->error_of_leaves(views.picture(5 * k)).squares, leaves,
                1e-3 * leaves + 1e-4);
    const TrainingError cut = host->error(views.picture(5 * k)),
                        found = device->error(views.picture(5 * k));
    EXPECT_NEAR(found.squares, cut.squares, 1e-3 * cut.squares + 1e-4);
    EXPECT_EQ(found.cut, cut.cut);
    double sum = 0, sum_found = 0;
    for (const NodeError& e : host->node_errors(views.picture(5 * k))) sum += double{e.squares};
    for (const NodeError& e : device->node_errors(views.picture(5 * k)))
      sum_found += double{e.squares};
    EXPECT_NEAR(sum_found, sum, 1e-3 * sum + 1e-4);
  }
}

}  // namespace
}  // namespace train_test
}  // namespace voyager::test
