// Sessions from start to exit, as runtimes begin, stop, starve and lose them.
#include <sys/stat.h>

#include "tests/openxr_headset/headset_run.h"

namespace voyager::test {
namespace session_test {
namespace {

// Under the validation layers of Vulkan (synchronisation included) and of OpenXR.
void expect_silence(const std::string& output) {
  EXPECT_EQ(output.find("validation: "), std::string::npos) << output;
}

TEST_F(Headset, TwoHundredFramesLeaveValidationNothingToSay) {
  const Outcome probe = run(headset("--frames 1 --validation"));
  if (probe.output.find("--validation: found no ") != std::string::npos)
    VOYAGER_SKIP_WITHOUT(VULKAN, probe.output);
  const Json script = {{"recommended", {48, 40}},
                       {"hidden_frames", {{0, 3}, {60, 4}}},
                       {"tracking_lost_frames", {{80, 5}}},
                       {"position_lost_frames", {{90, 5}}},
                       {"image_timeout_frames", {{100, 3}}},
                       {"image_order", "shuffled"},
                       {"events",
                        {{{"frame", 20}, {"do", "visible"}},
                         {{"frame", 30}, {"do", "focused"}},
                         {{"frame", 40}, {"do", "stop"}},
                         {{"frame", 70}, {"do", "mask_changed"}},
                         {{"frame", 110}, {"do", "lose_session"}, {"frames", 3}},
                         {{"frame", 130},
                          {"do", "recentre"},
                          {"position", {0.5, 0, 0.25}},
                          {"orientation", {0, 0.6, 0, 0.8}}},
                         {{"frame", 150}, {"do", "lose_instance"}},
                         {{"frame", 170}, {"do", "late"}, {"periods", 2}}}}};
  expect_silence(expect_well_behaved(script, "--frames 200 --validation"));
  EXPECT_EQ(counted("frames_with_projection"), 200u);
  EXPECT_EQ(counted("instances"), 2u);
}

TEST_F(Headset, AMinimalRuntimeLeavesValidationNothingToSay) {
  const Json script = {{"recommended", {31, 17}},
                       {"extensions", Json::array()},
                       {"formats", {"D32_SFLOAT", "B8G8R8A8_UNORM", "B8G8R8A8_SRGB"}}};
  const Outcome probe = run(headset("--frames 1 --validation"));
  if (probe.output.find("--validation: found no ") != std::string::npos)
    VOYAGER_SKIP_WITHOUT(VULKAN, probe.output);
  expect_silence(expect_well_behaved(script, "--frames 20 --validation --readback " + file("v")));
  expect_silence(expect_well_behaved(script, "--frames 20 --validation"));
  expect_silence(
      expect_well_behaved({{"recommended", {{31, 17}, {20, 24}}}}, "--frames 20 --validation"));
}

TEST_F(Headset, AStoppedSessionIsBegunAgain) {
  const std::string output = expect_well_behaved(
      {{"events", {{{"frame", 8}, {"do", "stop"}}, {{"frame", 20}, {"do", "stop"}}}}},
      "--frames 30");
  EXPECT_NE(output.find("30 frames shown"), std::string::npos) << output;
  EXPECT_NE(output.find("2 restarts, 0 losses"), std::string::npos) << output;
  EXPECT_EQ(counted("sessions"), 1u);
  EXPECT_EQ(counted("sessions_begun"), 3u);
}

TEST_F(Headset, ALostSessionIsMadeAnew) {
  const std::string output = expect_well_behaved(
      {{"events", {{{"frame", 8}, {"do", "lose_session"}, {"frames", 2}}}}}, "--frames 20");
  EXPECT_NE(output.find("20 frames shown"), std::string::npos) << output;
  EXPECT_NE(output.find("0 restarts, 1 losses"), std::string::npos) << output;
  EXPECT_EQ(counted("sessions"), 2u);
  EXPECT_EQ(counted("instances"), 1u);
}

TEST_F(Headset, ALossInTheMiddleOfAnyCallIsOvercome) {
  for (const std::string call :
       {"xrWaitFrame", "xrBeginFrame", "xrLocateViews", "xrSyncActions", "xrAcquireSwapchainImage",
        "xrWaitSwapchainImage", "xrReleaseSwapchainImage", "xrEndFrame"})
    for (const std::string result : {"XR_ERROR_SESSION_LOST", "XR_ERROR_INSTANCE_LOST"}) {
      write_script({{"recommended", {24, 16}},
                    {"failures", {{{"call", call}, {"frame", 8}, {"result", result}}}}});
      const Outcome outcome = run(headset("--frames 12"));
      EXPECT_EQ(outcome.exit_code, 0) << call << " " << result << "\n" << outcome.output;
      EXPECT_NE(outcome.output.find("12 frames shown"), std::string::npos)
          << call << " " << result << "\n"
          << outcome.output;
    }
}

// Frames end without a layer where there is nothing to show; they are not counted as shown.
TEST_F(Headset, NothingIsDrawnThatNobodySees) {
  expect_well_behaved({{"hidden_frames", {{0, 6}, {10, 5}}}}, "--frames 10");
  EXPECT_EQ(counted("frames_with_projection"), 10u);
  EXPECT_EQ(counted("frames_to_render"), 10u);
}

TEST_F(Headset, ALostHeadStaysWhereItWasLastSeen) {
  expect_well_behaved({{"hidden_frames", Json::array()},
                       {"tracking_lost_frames", {{4, 3}}},
                       {"position_lost_frames", {{4, 3}}}},
                      "--frames 10 --readback " + file("lost"));
  const Json cameras = read_json("lost/cameras.json");
  std::vector<Json> lefts;
  for (size_t i = 0; i < cameras.size(); i += 2) lefts.push_back(cameras[i]["position"]);
  int still = 0, moved = 0;
  for (size_t i = 1; i < lefts.size(); ++i) ++(lefts[i] == lefts[i - 1] ? still : moved);
  EXPECT_EQ(still, 3);
  EXPECT_EQ(moved, 6);
}

TEST_F(Headset, SwapchainsOfAnyNumberOfImagesServe) {
  for (const int images : {1, 2, 8})
    expect_well_behaved(
        {{"images", images}, {"image_order", "descending"}, {"image_timeout_frames", {{6, 2}}}},
        "--frames 12");
}

TEST_F(Headset, SkippedDisplayPeriodsAreMissed) {
  const std::string output = expect_well_behaved(
      {{"events", {{{"frame", 8}, {"do", "late"}, {"periods", 3}}}}}, "--frames 12");
  EXPECT_NE(output.find("3 display periods missed"), std::string::npos) << output;
}

// From 3 to the least there is, where there is time to spare; to the greatest where there is none.
TEST_F(Headset, TheGranularityFollowsATimeBudget) {
  EXPECT_NE(
      expect_well_behaved({}, "--frames 20 --time-budget 1e6").find("tau 1 to take 1e+06 ms;"),
      std::string::npos);
  EXPECT_NE(
      expect_well_behaved({}, "--frames 40 --time-budget 1e-6").find("tau 60 to take 1e-06 ms;"),
      std::string::npos);
}

// Three quarters of the period that the runtime tells. A frame takes longer on a CPU, so that τ
// rises from 3, and less on a GPU, so that it falls.
TEST_F(Headset, WithoutAChoiceTheDisplayGivesTheTimeBudget) {
  const std::string output = expect_well_behaved({{"period_ns", 1000000}}, "--frames 40");
  EXPECT_NE(output.find(" to take 0.75 ms;"), std::string::npos) << output;
  const size_t at = output.find("tau ");
  ASSERT_NE(at, std::string::npos) << output;
  EXPECT_NE(std::atof(output.c_str() + at + 4), 3) << output;
}

// With less memory than the scene takes, chunks come and go within the budget.
TEST_F(Headset, ABudgetBelowTheSceneStreams) {
  const std::string output =
      expect_well_behaved({}, "--frames 20 --tau 0.5 --budget " + std::to_string(small_budget()));
  const size_t at = output.find("streamed: ");
  ASSERT_NE(at, std::string::npos) << output;
  unsigned resident = 0, chunks = 0, read = 0;
  double megabytes = 0;
  ASSERT_EQ(std::sscanf(output.c_str() + at, "streamed: %u of %u chunks resident, %u read, %lf MB",
                        &resident, &chunks, &read, &megabytes),
            4)
      << output;
  EXPECT_GT(resident, 0u);
  EXPECT_LT(resident, chunks);
  EXPECT_LE(megabytes, small_budget());
}

// With the exit code, on one line that names what is wrong.
TEST_F(Headset, RefusalsAreOneLine) {
  write_bytes(file("bad.json"), "[{\"width\": 8, \"height\": 8}]");
  write_bytes(file("bad.voy"), "no scene");
  ASSERT_EQ(::mkfifo(file("pipe").c_str(), 0666), 0);
  std::filesystem::create_directory(file("dataset"));  // somebody's own
  std::filesystem::copy(file("city.cameras.json"), file("dataset/cameras.json"));
  write_bytes(file("dataset/0000_L.png"), "mine");
  for (const std::string other : {"{}", "null"}) {
    std::filesystem::create_directory(file("dataset" + other));
    write_bytes(file("dataset" + other + "/cameras.json"), other);
  }
  const std::string scene = "openxr_headset " + file("city.voy");
  const struct {
    std::string command;
    int exit_code;
    std::string names;
  } cases[] = {
      {"openxr_headset", 1, "SCENE"},
      {scene + " --frames 0", 1, "--frames"},
      {scene + " --frames -3", 1, "--frames"},
      {scene + " --tau -1", 1, "--tau"},
      {scene + " --time-budget 0", 1, "--time-budget"},
      {scene + " --time-budget 8 --tau 3", 1, "--time-budget"},
      {scene + " --budget -1", 1, "--budget"},
      {scene + " --frames 1 --budget 0.001", 4, "budget"},
      {scene + " --readback " + file("refused"), 1, "--readback"},
      {scene + " --frames 1 --camera-file " + file("absent.json"), 2, "absent.json"},
      {scene + " --frames 1 --camera-file " + file("bad.json"), 2, "bad.json: camera 0"},
      {"openxr_headset --frames 1 " + file("absent.voy"), 2, "absent.voy"},
      {"openxr_headset --frames 1 " + file("bad.voy"), 2, "bad.voy"},
      {scene + " --frames 1 --readback /proc/none", 4, "/proc/none"},
      {scene + " --frames 1 --readback " + file("dataset"), 1, "dataset/cameras.json"},
      {scene + " --frames 1 --readback '" + file("dataset{}'"), 1, "dataset{}/cameras.json"},
      {scene + " --frames 1 --readback " + file("datasetnull"), 1, "datasetnull/cameras.json"},
      {scene + " --frames 1 --camera-file " + file("pipe"), 2, "pipe: found a pipe or device"},
      {"openxr_headset --frames 1 " + file("pipe"), 2, "pipe: found a FIFO"},
  };
  for (const auto& c : cases) {
    const Outcome result = run_shell("timeout 60 " + program(c.command) + " > /dev/null");
    EXPECT_EQ(result.exit_code, c.exit_code) << c.command << "\n" << result.output;
    EXPECT_NE(result.output.find(c.names), std::string::npos) << c.command << "\n" << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << c.command << "\n"
                                                                               << result.output;
  }
  EXPECT_FALSE(std::filesystem::exists(file("refused")));
  EXPECT_EQ(file_bytes(file("dataset/cameras.json")), file_bytes(file("city.cameras.json")));
  EXPECT_EQ(file_bytes(file("dataset/0000_L.png")), "mine");
  EXPECT_EQ(file_bytes(file("dataset{}/cameras.json")), "{}");
  EXPECT_EQ(file_bytes(file("datasetnull/cameras.json")), "null");
}

TEST_F(Headset, ARecordingDoesNotReplaceItsCameras) {
  expect_well_behaved(Json::object(), "--frames 2 --readback " + file("own"));
  const std::string before = file_bytes(file("own/cameras.json"));
  std::filesystem::create_symlink("own/cameras.json", file("cameras_link.json"));
  std::filesystem::create_directory(file("other"));
  write_bytes(file("other/0007_R.png"), before);
  for (const auto& [cameras, folder] :
       {std::pair("own/cameras.json", "own"), std::pair("cameras_link.json", "own"),
        std::pair("other/0007_R.png", "other")}) {
    const Outcome result = run("openxr_headset " + file("city.voy") + " --frames 1 --camera-file " +
                               file(cameras) + " --readback " + file(folder));
    EXPECT_EQ(result.exit_code, 1) << result.output;
    EXPECT_NE(result.output.find("found it as an output"), std::string::npos) << result.output;
    EXPECT_EQ(file_bytes(file(cameras)), before) << cameras;
  }
}

TEST_F(Headset, WhatARuntimeLacksIsNamed) {
  const struct {
    Json script;
    std::string names;
  } cases[] = {
      {{{"formats", {"D32_SFLOAT"}}}, "swapchain formats"},
      {{{"failures", {{{"call", "xrGetSystem"}, {"result", "XR_ERROR_FORM_FACTOR_UNSUPPORTED"}}}}},
       "found no headset"},
      {{{"failures", {{{"call", "xrCreateSession"}, {"result", "XR_ERROR_LIMIT_REACHED"}}}}},
       "xrCreateSession: XR_ERROR_LIMIT_REACHED"},
  };
  for (const auto& c : cases) {
    write_script(c.script);
    const Outcome result = run(headset("--frames 1 2>&1 > /dev/null"));
    EXPECT_EQ(result.exit_code, 4) << c.script << "\n" << result.output;
    EXPECT_NE(result.output.find(c.names), std::string::npos) << c.script << "\n" << result.output;
  }
  setenv("XR_RUNTIME_JSON", file("no_runtime.json").c_str(), 1);
  const Outcome result = run(headset("--frames 1"));
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.output.find("found no OpenXR runtime"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("no_runtime.json"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace session_test
}  // namespace voyager::test
