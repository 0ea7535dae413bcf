// Runtimes that refuse what is optional, fail, or never come: what can be shown is shown, what
// was recorded is kept, and Ctrl-C is heard.
#include <algorithm>
#include <filesystem>
#include <set>

#include "tests/openxr_headset/headset_run.h"

namespace voyager::test {
namespace odd_runtime_test {
namespace {

class OddRuntime : public Headset {
 protected:
  static Json failure(const std::string& call, const std::string& result, int times,
                      int after = 0) {
    return {{"call", call}, {"result", result}, {"times", times}, {"after", after}};
  }
  static std::set<std::string> names_in(const std::string& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(file(folder)))
      names.insert(entry.path().filename().string());
    return names;
  }
  // As if Ctrl-C were pressed after so many seconds; 137 where it is not heard in ten more.
  static Outcome run_interrupted(const std::string& seconds, const std::string& options) {
    return run(
        headset(options) + " & headset=$!; { sleep " + seconds +
        "; kill -INT $headset; sleep 10; kill -KILL $headset; } > /dev/null 2>&1 & killer=$!; "
        "wait $headset; code=$?; kill $killer; exit $code");
  }
};

size_t count(const std::string& text, const std::string& part) {
  size_t found = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST_F(OddRuntime, AMaskThatCannotBeHadIsDoneWithout) {
  const std::string output = expect_well_behaved(
      {{"failures", {failure("xrGetVisibilityMaskKHR", "XR_ERROR_RUNTIME_FAILURE", 100)}}},
      "--frames 3");
  EXPECT_EQ(count(output, "xrGetVisibilityMaskKHR: XR_ERROR_RUNTIME_FAILURE"), 1u) << output;
}

// Refused in both layouts, whatever the error: then the next format, at last none.
TEST_F(OddRuntime, EveryFormatIsTried) {
  for (const std::string result :
       {"XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED", "XR_ERROR_VALIDATION_FAILURE"}) {
    expect_well_behaved({{"failures", {failure("xrCreateSwapchain", result, 2)}}},
                        "--frames 3 --readback " + file("next"));
    EXPECT_EQ(read_json("report.json")["calls"]["xrCreateSwapchain"], 4);  // the fourth is depth
    expect_rendered("next", 3, 1, result);
  }
  write_script({{"failures", {failure("xrCreateSwapchain", "XR_ERROR_RUNTIME_FAILURE", 100)}}});
  const Outcome none = run(headset("--frames 1"));
  EXPECT_EQ(none.exit_code, 4);
  EXPECT_NE(none.output.find("found none of R8G8B8A8_SRGB, R16G16B16A16_SFLOAT, R8G8B8A8_UNORM "
                             "(xrCreateSwapchain: XR_ERROR_RUNTIME_FAILURE)"),
            std::string::npos)
      << none.output;
}

TEST_F(OddRuntime, DepthThatIsRefusedIsDoneWithout) {
  expect_well_behaved(
      {{"failures", {failure("xrCreateSwapchain", "XR_ERROR_VALIDATION_FAILURE", 100, 1)}}},
      "--frames 3 --readback " + file("flat"));
  expect_rendered("flat", 3, 1, "without depth");
}

TEST_F(OddRuntime, ItsHighestVulkanIsNoLimit) {
  const std::string output = expect_well_behaved({{"vulkan", {1, 0, 1, 0}}}, "--frames 3");
  EXPECT_EQ(count(output, "found Vulkan 1.0 tested at most, expected 1.1"), 1u) << output;
  EXPECT_EQ(expect_well_behaved({}, "--frames 3").find("tested at most"), std::string::npos);
}

TEST_F(OddRuntime, ImagesInNoLayoutAreDrawnTo) {
  const Outcome probe = run(headset("--frames 1 --validation"));
  if (probe.output.find("--validation: found no ") != std::string::npos)
    VOYAGER_SKIP_WITHOUT(VULKAN, probe.output);
  for (const std::string& options : {std::string(), " --readback " + file("lax")})
    EXPECT_EQ(
        count(expect_well_behaved({{"image_layouts", false}}, "--frames 8 --validation" + options),
              "validation: "),
        0u);
}

// The request to exit is not heard, the session is stopped and never begun again.
TEST_F(OddRuntime, WhenAllIsShownASessionThatIsStoppedIsLeft) {
  for (const Json& polls : {Json(), Json(3)}) {
    write_script({{"failures", {failure("xrRequestExitSession", "XR_SESSION_LOSS_PENDING", 1)}},
                  {"events", {{{"frame", 12}, {"do", "stop"}, {"restart_polls", polls}}}}});
    const Outcome result = run(headset("--frames 5 --readback " + file("left")));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    EXPECT_NE(result.output.find("5 frames shown"), std::string::npos) << result.output;
    expect_rendered("left", 5, 1, "stopped");
  }
}

TEST_F(OddRuntime, AFailureLeavesWhatWasRecorded) {
  expect_well_behaved({}, "--frames 9 --readback " + file("kept"));
  write_bytes(file("kept/mine_L.png"), "");
  write_bytes(file("kept/00001_L.png"), "");
  write_script({{"failures", {failure("xrEndFrame", "XR_ERROR_RUNTIME_FAILURE", 1, 8)}}});
  const Outcome result = run(headset("--frames 9 --readback " + file("kept")));
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.output.find("xrEndFrame: XR_ERROR_RUNTIME_FAILURE"), std::string::npos)
      << result.output;
  const int frames = static_cast<int>(read_json("kept/cameras.json").size() / 2);
  EXPECT_GE(frames, 3);
  EXPECT_LT(frames, 9);
  // Of the longer recording before nothing is left, of anyone else's files everything.
  EXPECT_EQ(names_in("kept").size(), 2 * static_cast<size_t>(frames) + 3);
  EXPECT_TRUE(names_in("kept").contains("mine_L.png"));
  EXPECT_TRUE(names_in("kept").contains("00001_L.png"));
  expect_rendered("kept", frames, 1, "until the failure");
}

TEST_F(OddRuntime, SessionsLostOneAfterTheOtherAreTakenSlowly) {
  write_script(
      {{"failures", {failure("xrCreateReferenceSpace", "XR_ERROR_SESSION_LOST", 1000000)}}});
  const Outcome result = run_interrupted("3", "--frames 1");
  EXPECT_EQ(result.exit_code, 0) << result.output.substr(0, 1000);
  EXPECT_GE(count(result.output, "starting again"), 1u);
  EXPECT_LE(count(result.output, "starting again"), 30u);
}

TEST_F(OddRuntime, CtrlCIsHeardWhileThereIsNoHeadset) {
  write_script(
      {{"failures", {failure("xrGetSystem", "XR_ERROR_FORM_FACTOR_UNAVAILABLE", 1000000)}}});
  const Outcome result = run_interrupted("1", "");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("no headset yet"), std::string::npos) << result.output;
}

TEST_F(OddRuntime, OneThatIsUnavailableIsNamed) {
  write_script({{"failures", {failure("xrCreateInstance", "XR_ERROR_RUNTIME_UNAVAILABLE", 100)}}});
  const Outcome result = run(headset("--frames 1"));
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.output.find("found no OpenXR runtime (XR_ERROR_RUNTIME_UNAVAILABLE)"),
            std::string::npos)
      << result.output;
  EXPECT_NE(result.output.find("XR_RUNTIME_JSON is "), std::string::npos) << result.output;
}

TEST_F(OddRuntime, AScriptThatIsRefusedIsNamedOnce) {
  write_script({{"colour", 1}});
  const Outcome result = run(headset("--frames 1"));
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(count(result.output, "colour: found"), 1u) << result.output;
  EXPECT_EQ(count(result.output, "found no OpenXR runtime"), 0u) << result.output;
}

TEST_F(OddRuntime, FlippedFieldsOfViewAreToldOfOnce) {
  const std::string output = expect_well_behaved({{"flipped_frames", {{5, 3}}}}, "--frames 6");
  EXPECT_EQ(count(output, "xrLocateViews: found the angles of no frustum"), 1u) << output;
}

// Where only the position is lost, the head still turns, about where it was.
TEST_F(OddRuntime, AHeadOfUnknownPositionTurns) {
  expect_well_behaved({{"hidden_frames", Json::array()}, {"position_lost_frames", {{4, 3}}}},
                      "--frames 8 --readback " + file("turns"));
  const Json cameras = read_json("turns/cameras.json");
  ASSERT_EQ(cameras.size(), 16u);
  const auto middle = [&](size_t frame, size_t axis) {
    return (cameras[2 * frame]["position"][axis].get<double>() +
            cameras[2 * frame + 1]["position"][axis].get<double>()) /
           2;
  };
  size_t still = 0;
  for (size_t i = 1; i < 8; ++i) {
    double moved = 0;
    for (size_t axis = 0; axis < 3; ++axis)
      moved = std::max(moved, std::abs(middle(i, axis) - middle(i - 1, axis)));
    still += moved < 1e-5;
    EXPECT_NE(cameras[2 * i]["rotation"], cameras[2 * i - 2]["rotation"]) << i;
  }
  EXPECT_EQ(still, 3u);
}

}  // namespace
}  // namespace odd_runtime_test
}  // namespace voyager::test
