// A view that is given milliseconds in place of tau.
#include <fstream>
#include <iterator>

#include "hostile.h"

namespace time_budget_test {
namespace {

VoyTimeBudget budget_of(double milliseconds) {
  VoyTimeBudget budget = VOY_TIME_BUDGET_INIT;
  budget.milliseconds = milliseconds;
  return budget;
}

// Host's scene is flat, so that it refuses budgets; this view draws a small tree.
class TimeBudget : public Hostile {
 protected:
  TimeBudget() {
    std::ifstream file(VOYAGER_SOURCE_DIR "/tests/fuzz/corpus/voy/compact_sh1.voy",
                       std::ios::binary);
    bytes_.bytes.assign(std::istreambuf_iterator<char>(file), {});
    const VoyByteSource source = bytes_.source();
    VoySceneDesc desc = VOY_SCENE_DESC_INIT;
    desc.source = &source;
    EXPECT_EQ(voy.OpenScene(host.device, &desc, &scene), VOY_SUCCESS) << voy.message();
    EXPECT_EQ(create(nullptr, &view), VOY_SUCCESS) << voy.message();
  }
  VoyViewDesc tree_desc(const VoyTimeBudget* budget) {
    VoyViewDesc desc = host.view_desc();
    desc.scenes = &scene;
    desc.next = budget;
    return desc;
  }
  VoyResult create(const VoyTimeBudget* budget, VoyView* made) {
    const VoyViewDesc desc = tree_desc(budget);
    return voy.CreateView(host.device, &desc, made);
  }
  // The stats of one more frame of the view.
  VoyFrameStats draw(VoyView drawn) {
    const VoyFrameEye eye = host.eye();
    const VoyFrame frame = Host::frame(eye);
    EXPECT_EQ(voy.RenderFrame(drawn, &frame), VOY_SUCCESS) << voy.message();
    VoyFrameStats stats = VOY_FRAME_STATS_INIT;
    EXPECT_EQ(voy.GetFrameStats(drawn, &stats), VOY_SUCCESS) << voy.message();
    return stats;
  }

  VoyScene scene = nullptr;
  VoyView view = nullptr;

 private:
  BytesHost bytes_;
};

TEST_F(TimeBudget, WithoutOneStatsTellTheTauThatWasSet) {
  EXPECT_EQ(draw(view).tau, 3);
  ASSERT_EQ(voy.SetViewTau(view, 0.1), VOY_SUCCESS);
  const VoyFrameStats stats = draw(view);
  EXPECT_EQ(stats.tau, 0.1);
  EXPECT_EQ(stats.millisecondsBudget, 0);
  EXPECT_EQ(stats.timeBudgetState, VOY_TIME_BUDGET_STATE_NONE);
}

TEST_F(TimeBudget, TooLittleTimeRaisesTauToTheGreatestAndSaysSo) {
  const VoyTimeBudget budget = budget_of(1e-9);
  VoyView steered = nullptr;
  ASSERT_EQ(create(&budget, &steered), VOY_SUCCESS) << voy.message();
  VoyFrameStats stats = draw(steered);
  EXPECT_EQ(stats.tau, 3);
  EXPECT_EQ(stats.millisecondsBudget, 1e-9);
  EXPECT_EQ(stats.timeBudgetState, VOY_TIME_BUDGET_STATE_LATE);
  double last = 3;
  for (int i = 0; i < 30; ++i) {
    stats = draw(steered);
    EXPECT_GE(stats.tau, last);
    last = stats.tau;
  }
  EXPECT_EQ(stats.tau, 60);
  EXPECT_EQ(stats.timeBudgetState, VOY_TIME_BUDGET_STATE_UNREACHABLE);
}

TEST_F(TimeBudget, TimeToSpareLowersTauToTheLeast) {
  VoyTimeBudget budget = budget_of(1e9);
  budget.minTau = 0.5;
  ASSERT_EQ(voy.SetViewTimeBudget(view, &budget), VOY_SUCCESS) << voy.message();
  VoyFrameStats stats = draw(view);
  for (int i = 0; i < 30; ++i) stats = draw(view);
  EXPECT_EQ(stats.tau, 0.5);
  EXPECT_EQ(stats.timeBudgetState, VOY_TIME_BUDGET_STATE_HELD);
}

TEST_F(TimeBudget, SettingTauEndsItAndGivesTheSameImage) {
  const VoyTimeBudget budget = budget_of(1e-9);
  ASSERT_EQ(voy.SetViewTimeBudget(view, &budget), VOY_SUCCESS);
  for (int i = 0; i < 7; ++i) {
    const VoyFrameStats steered = draw(view);
    const std::vector<float> pixels = host.pixels, depth = host.depth;
    VoyView fixed = nullptr;
    ASSERT_EQ(create(nullptr, &fixed), VOY_SUCCESS);
    ASSERT_EQ(voy.SetViewTau(fixed, steered.tau), VOY_SUCCESS);
    EXPECT_EQ(draw(fixed).tauStar, steered.tauStar);
    EXPECT_EQ(host.pixels, pixels) << steered.tau;
    EXPECT_EQ(host.depth, depth) << steered.tau;
    EXPECT_EQ(voy.DestroyView(fixed), VOY_SUCCESS);
  }
  ASSERT_EQ(voy.SetViewTau(view, 2), VOY_SUCCESS);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(draw(view).tau, 2);
  EXPECT_EQ(draw(view).timeBudgetState, VOY_TIME_BUDGET_STATE_NONE);
}

TEST_F(TimeBudget, IsChangedWhileFramesGoOn) {
  VoyTimeBudget budget = budget_of(1e-9);
  ASSERT_EQ(voy.SetViewTimeBudget(view, &budget), VOY_SUCCESS);
  for (int i = 0; i < 30; ++i) draw(view);
  budget.maxTau = 20;
  ASSERT_EQ(voy.SetViewTimeBudget(view, &budget), VOY_SUCCESS);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(draw(view).tau, 20) << "the range counts at once";
}

TEST_F(TimeBudget, Refusals) {
  VoyView made = nullptr;
  const auto refused = [&](auto&& change, const char* part) {
    VoyTimeBudget budget = budget_of(10);
    change(budget);
    expect_invalid(voy.SetViewTimeBudget(view, &budget), part);
    expect_invalid(create(&budget, &made), part);
    EXPECT_EQ(made, nullptr);
  };
  for (const double bad : {0.0, -0.0, -1.0, kNan, kInf, -kInf})
    refused([&](VoyTimeBudget& b) { b.milliseconds = bad; }, "VoyTimeBudget.milliseconds: found");
  for (const double bad : {-1e-9, kNan, kInf, -kInf})
    refused([&](VoyTimeBudget& b) { b.minTau = bad; }, "VoyTimeBudget.minTau: found");
  for (const double bad : {0.99, -1.0, kNan, kInf})
    refused([&](VoyTimeBudget& b) { b.maxTau = bad; }, "VoyTimeBudget.maxTau: found");
  EXPECT_EQ(draw(view).timeBudgetState, VOY_TIME_BUDGET_STATE_NONE) << "a refused one was set";

  VoyTimeBudget budget = budget_of(10);
  expect_invalid(voy.SetViewTimeBudget(view, nullptr), "VoyTimeBudget");
  expect_refused(voy.SetViewTimeBudget(nullptr, &budget), VOY_ERROR_INVALID_HANDLE, "");
  budget.next = &budget;
  expect_refused(create(&budget, &made), VOY_ERROR_INVALID_STRUCTURE, "two structures");
  expect_refused(voy.SetViewTimeBudget(view, &budget), VOY_ERROR_INVALID_STRUCTURE, "next");
  budget = budget_of(10);
  budget.type = VOY_STRUCTURE_TYPE_FRAME;
  expect_refused(voy.SetViewTimeBudget(view, &budget), VOY_ERROR_INVALID_STRUCTURE, "expected 29");
}

TEST_F(TimeBudget, IsRefusedWhereTauChangesNothing) {
  const VoyTimeBudget budget = budget_of(10);
  VoyView made = nullptr;
  VoyViewDesc leaves = tree_desc(&budget);
  leaves.lod = VOY_LOD_ALL_LEAVES;
  expect_refused(voy.CreateView(host.device, &leaves, &made), VOY_ERROR_UNSUPPORTED,
                 "a view of every leaf");
  EXPECT_EQ(made, nullptr);
  // One instance with a tree is enough.
  const VoyScene both[] = {host.scene, scene};
  VoyViewDesc mixed = tree_desc(&budget);
  mixed.instanceCount = 2;
  mixed.scenes = both;
  ASSERT_EQ(voy.CreateView(host.device, &mixed, &made), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(draw(made).millisecondsBudget, 10);
}

}  // namespace
}  // namespace time_budget_test
