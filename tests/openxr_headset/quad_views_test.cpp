// Two pictures an eye: a coarse one of everything, a sharp one of its middle.
#include "tests/openxr_headset/headset_run.h"

namespace voyager::test {
namespace quad_views_test {
namespace {

class QuadViews : public Headset {
 protected:
  static Json with_sizes(Json script) {
    script["recommended"] = {{64, 48}, {64, 48}, {72, 54}, {72, 54}};
    return script;
  }
  static std::string readback(const std::string& name) { return " --readback " + file(name); }
};

TEST_F(QuadViews, ShowWhatVoyagerRenders) {
  expect_well_behaved(with_sizes({}), "--quad-views --frames 4" + readback("four"));
  EXPECT_EQ(read_json("report.json")["calls"]["xrCreateSwapchain"], 4);  // of two layers each
  expect_rendered("four", 4, 1, "four views", 4);
  const Json cameras = read_json("four/cameras.json");
  for (size_t i = 0; i < cameras.size(); i += 4)
    for (size_t eye = i; eye < i + 2; ++eye) {
      EXPECT_EQ(cameras[eye]["position"], cameras[eye + 2]["position"]);
      // 72 pixels over three eighths of what 64 see.
      EXPECT_NEAR(cameras[eye + 2]["fx"].get<double>() / cameras[eye]["fx"].get<double>(), 3, 1e-4);
    }
}

// The runtime's own account, of what its compositor was given.
TEST_F(QuadViews, ReachTheCompositorInTheOrderThatItAskedFor) {
  const Json start = read_json("city.cameras.json")[0];
  const Json placed = {{"position", start["position"]}, {"orientation", {1, 0, 0, 0}}};
  expect_well_behaved(
      with_sizes({{"extensions", {"XR_KHR_composition_layer_depth", "XR_VARJO_quad_views"}},
                  {"local_in_scene", placed},
                  {"output", file("given")}}),
      "--quad-views --frames 3 --tau 3");
  expect_rendered("given", 3, 1, "as shown", 4);
  const Picture outer = read_pfm(file("given/0000_L.pfm")),
                inner = read_pfm(file("given/0000_L_inner.pfm"));
  EXPECT_EQ(outer.values.size(), size_t{64} * 48);
  EXPECT_EQ(inner.values.size(), size_t{72} * 54);
}

TEST_F(QuadViews, OfFourSizesHaveASwapchainEach) {
  expect_well_behaved({{"recommended", {{64, 48}, {60, 40}, {72, 54}, {33, 41}}}},
                      "--quad-views --frames 3" + readback("sizes"));
  EXPECT_EQ(read_json("report.json")["calls"]["xrCreateSwapchain"], 8);
  expect_rendered("sizes", 3, 1, "four sizes", 4);
}

// Each pair has its part of the time, as its part of the pixels: 3072 and 3888.
TEST_F(QuadViews, ShareATimeBudget) {
  const std::string output =
      expect_well_behaved(with_sizes({}), "--quad-views --frames 20 --time-budget 6960000");
  EXPECT_NE(output.find("tau 1 to take 3.072e+06 ms, inner tau 1 to take 3.888e+06 ms;"),
            std::string::npos)
      << output;
}

TEST_F(QuadViews, AreStreamedWithinABudget) {
  const std::string output =
      expect_well_behaved(with_sizes({}), "--quad-views --frames 20 --tau 0.5 --budget " +
                                              std::to_string(small_budget()));
  EXPECT_NE(output.find("tau 0.5, inner tau 0.5; streamed: "), std::string::npos) << output;
  const size_t at = output.find(" read, ");
  ASSERT_NE(at, std::string::npos) << output;
  // MB, of one scene for both pairs.
  EXPECT_LE(std::atof(output.c_str() + at + 7), small_budget()) << output;
}

TEST_F(QuadViews, LeaveValidationNothingToSay) {
  const Outcome probe = run(headset("--frames 1 --validation"));
  if (probe.output.find("--validation: found no ") != std::string::npos)
    VOYAGER_SKIP_WITHOUT(VULKAN, probe.output);
  const Json script = with_sizes({{"hidden_frames", {{0, 3}, {20, 2}}},
                                  {"tracking_lost_frames", {{24, 2}}},
                                  {"position_lost_frames", {{26, 2}}},
                                  {"events",
                                   {{{"frame", 8}, {"do", "stop"}},
                                    {{"frame", 16}, {"do", "mask_changed"}},
                                    {{"frame", 30}, {"do", "lose_session"}, {"frames", 2}}}}});
  const std::string output = expect_well_behaved(script, "--quad-views --frames 40 --validation");
  EXPECT_EQ(output.find("validation: "), std::string::npos) << output;
  EXPECT_EQ(counted("frames_with_projection"), 40u);
  EXPECT_EQ(counted("sessions"), 2u);
}

TEST_F(QuadViews, AreNamedWhereARuntimeHasNone) {
  write_script({{"extensions", Json::array()}});
  const Outcome result = run(headset("--quad-views --frames 1 2>&1 > /dev/null"));
  EXPECT_EQ(result.exit_code, 4) << result.output;
  EXPECT_NE(result.output.find("--quad-views: found an OpenXR runtime or loader without "
                               "XR_VARJO_quad_views and without OpenXR 1.1"),
            std::string::npos)
      << result.output;
  EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
}

// Who does not ask for them has one picture an eye, wherever.
TEST_F(QuadViews, AreNotTakenUnasked) {
  expect_well_behaved(with_sizes({}), "--frames 3" + readback("two"));
  expect_rendered("two", 3, 1, "two views");
}

// A recording of either kind gives way to one of the other.
TEST_F(QuadViews, ReplaceARecordingOfTwo) {
  expect_well_behaved(with_sizes({}), "--frames 3" + readback("turns"));
  expect_well_behaved(with_sizes({}), "--quad-views --frames 2" + readback("turns"));
  EXPECT_FALSE(std::filesystem::exists(file("turns/0002_L.png")));
  expect_well_behaved(with_sizes({}), "--frames 1" + readback("turns"));
  EXPECT_FALSE(std::filesystem::exists(file("turns/0000_L_inner.png")));
  expect_rendered("turns", 1, 1, "one again");
}

}  // namespace
}  // namespace quad_views_test
}  // namespace voyager::test
