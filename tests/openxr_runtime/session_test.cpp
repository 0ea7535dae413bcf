// Whole sessions through the real loader, under both validation layers.
#include <algorithm>
#include <chrono>
#include <thread>

#include "tests/openxr_runtime/client.h"

namespace test_runtime::test {
namespace session_test {
namespace {

const char* kCoreValidation = "XR_APILAYER_LUNARG_core_validation";

// What the core-validation layer wrote; it takes its orders from the environment.
void tell_core_validation(const Stage& stage) {
  ::setenv("XR_CORE_VALIDATION_EXPORT_TYPE", "text", 1);
  ::setenv("XR_CORE_VALIDATION_FILE_NAME", stage.file("said.txt").c_str(), 1);
}
std::string said_by_core_validation(const Stage& stage) {
  std::ifstream file(stage.file("said.txt"));
  return {std::istreambuf_iterator<char>(file), {}};
}

Json states(const Json& report) {
  Json names = Json::array();
  for (const Json& entry : report["states"])
    names.push_back(entry["state"].get<std::string>().substr(std::strlen("XR_SESSION_STATE_")));
  return names;
}

void expect_clean(const Json& report) {
  EXPECT_EQ(report["violations"], Json::array());
  EXPECT_EQ(report["remarks"], Json::array());
}

TEST(Session, AGoodOneIsReportedClean) {
  const Stage stage(Json{{"events", {{{"frame", 20}, {"do", "exit"}}}}});
  tell_core_validation(stage);
  {
    Client client(kAllExtensions, {kCoreValidation});
    VOYAGER_NEEDS_VULKAN(client);
    client.create_session();
    client.create_swapchains();
    EXPECT_TRUE(client.run(100));
    EXPECT_EQ(client.state, XR_SESSION_STATE_EXITING);
  }
  const Json report = stage.report();
  expect_clean(report);
  EXPECT_EQ(states(report), Json({"IDLE", "READY", "SYNCHRONIZED", "VISIBLE", "FOCUSED", "VISIBLE",
                                  "SYNCHRONIZED", "STOPPING", "IDLE", "EXITING"}));
  EXPECT_EQ(report["counts"]["frames_ended"], 21);
  EXPECT_EQ(report["counts"]["frames_with_projection"], 17);  // not 0 to 2, and not the last
  EXPECT_EQ(said_by_core_validation(stage), "");
}

// That the silence above means something.
TEST(Session, TheCoreValidationLayerIsHeard) {
  const Stage stage(Json::object());
  tell_core_validation(stage);
  {
    Client client(kAllExtensions, {kCoreValidation});
    VOYAGER_NEEDS_VULKAN(client);
    EXPECT_EQ(xrPollEvent(client.instance, nullptr), XR_ERROR_VALIDATION_FAILURE);
  }
  EXPECT_NE(said_by_core_validation(stage), "");
}

TEST(Session, StopsAndStartsAgain) {
  const Stage stage(Json{
      {"events",
       {{{"frame", 6}, {"do", "stop"}, {"restart_polls", 2}}, {{"frame", 12}, {"do", "exit"}}}}});
  {
    Client client;
    VOYAGER_NEEDS_VULKAN(client);
    client.create_session();
    client.create_swapchains();
    EXPECT_TRUE(client.run(100));
  }
  const Json report = stage.report();
  expect_clean(report);
  EXPECT_EQ(report["counts"]["sessions_begun"], 2);
  EXPECT_EQ(report["counts"]["frames_ended"], 13);
}

TEST(Session, ALostOneIsMadeAgainAndFramesGoOn) {
  const Stage stage(
      Json{{"events", {{{"frame", 5}, {"do", "lose_session"}}, {{"frame", 12}, {"do", "exit"}}}}});
  {
    Client client;
    VOYAGER_NEEDS_VULKAN(client);
    client.create_session();
    client.create_swapchains();
    EXPECT_TRUE(client.run(7));
    EXPECT_EQ(client.state, XR_SESSION_STATE_LOSS_PENDING);
    EXPECT_EQ(client.whole_frame(), XR_SESSION_LOSS_PENDING);
    EXPECT_EQ(client.whole_frame(), XR_ERROR_SESSION_LOST);
    EXPECT_EQ(client.locate(), XR_ERROR_SESSION_LOST);
    client.destroy_session();
    client.create_session();
    client.create_swapchains();
    client.running = false;
    client.poll();
    EXPECT_EQ(client.state, XR_SESSION_STATE_READY);
    EXPECT_TRUE(client.run(100));
    EXPECT_EQ(client.state, XR_SESSION_STATE_EXITING);
  }
  const Json report = stage.report();
  expect_clean(report);
  EXPECT_EQ(report["counts"]["sessions"], 2);
}

TEST(Session, ALostInstanceIsMadeAgainUnderTheSameReport) {
  const Stage stage(Json{{"events", {{{"frame", 4}, {"do", "lose_instance"}, {"frames", 1}}}}});
  for (const bool first : {true, false}) {
    Client client;
    VOYAGER_NEEDS_VULKAN(client);
    client.start();
    for (int i = 0; i < 5; ++i) EXPECT_GE(client.whole_frame(), 0);
    client.poll();
    const auto told = std::count(client.events.begin(), client.events.end(),
                                 XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING);
    EXPECT_EQ(told, first ? 1 : 0);
    EXPECT_EQ(client.whole_frame(), first ? XR_ERROR_INSTANCE_LOST : XR_SUCCESS);
  }
  const Json report = stage.report();
  expect_clean(report);
  EXPECT_EQ(report["counts"]["instances"], 2);
}

TEST(Session, LosesFocusAndIsHidden) {
  const Stage stage(Json{{"hidden_frames", {{8, 2}}},
                         {"events",
                          {{{"frame", 4}, {"do", "visible"}},
                           {{"frame", 5}, {"do", "synchronized"}},
                           {{"frame", 6}, {"do", "focused"}}}}});
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  client.start();
  const bool shown[] = {false, true, true, true, true, false, true, true, false, false, true};
  for (const bool expected : shown) {
    ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
    EXPECT_EQ(client.frame.shouldRender, static_cast<XrBool32>(expected));
  }
}

TEST(Session, ExitOnRequestGoesThroughEveryState) {
  const Stage stage(Json::object());
  {
    Client client;
    VOYAGER_NEEDS_VULKAN(client);
    client.start();
    client.running = true;
    for (int i = 0; i < 4; ++i) client.whole_frame();
    EXPECT_EQ(xrRequestExitSession(client.session), XR_SUCCESS);
    EXPECT_TRUE(client.run(10));
    EXPECT_EQ(client.state, XR_SESSION_STATE_EXITING);
  }
  expect_clean(stage.report());
}

TEST(Session, AScriptedFailureIsNoViolation) {
  const Stage stage(
      Json{{"failures",
            {{{"call", "xrEndFrame"}, {"frame", 4}, {"result", "XR_ERROR_RUNTIME_FAILURE"}},
             {{"call", "xrLocateViews"},
              {"frame", 6},
              {"times", 2},
              {"result", "XR_ERROR_OUT_OF_MEMORY"}}}}});
  {
    Client client;
    VOYAGER_NEEDS_VULKAN(client);
    client.start();
    for (int i = 0; i < 4; ++i) EXPECT_EQ(client.whole_frame(), XR_SUCCESS);
    EXPECT_EQ(client.whole_frame(), XR_ERROR_RUNTIME_FAILURE);
    EXPECT_EQ(client.wait(), XR_SUCCESS);
    EXPECT_EQ(client.begin(), XR_FRAME_DISCARDED);
    EXPECT_EQ(client.end(false), XR_SUCCESS);
    EXPECT_EQ(client.whole_frame(), XR_ERROR_OUT_OF_MEMORY);
  }
  const Json report = stage.report();
  expect_clean(report);
  EXPECT_EQ(report["counts"]["frames_discarded"], 1);
}

TEST(Session, DisplayTimesKeepThePeriodUnlessLate) {
  const Stage stage(
      Json{{"period_ns", 10000000}, {"events", {{{"frame", 3}, {"do", "late"}, {"periods", 2}}}}});
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  client.start();
  XrTime last = 0;
  for (int i = 0; i < 6; ++i) {
    ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
    EXPECT_EQ(client.frame.predictedDisplayPeriod, 10000000);
    if (i > 0) {
      EXPECT_EQ(client.frame.predictedDisplayTime - last, i == 3 ? 30000000 : 10000000);
    }
    last = client.frame.predictedDisplayTime;
  }
}

// A pipelined application waits for the next frame on a thread of its own.
TEST(Session, AnotherThreadWaitsUntilTheFrameIsBegun) {
  const Stage stage(Json::object());
  {
    Client client;
    VOYAGER_NEEDS_VULKAN(client);
    client.start();
    for (int i = 0; i < 20; ++i) {
      ASSERT_EQ(client.wait(), XR_SUCCESS);
      std::thread next([&] {
        auto state = typed<XrFrameState>(XR_TYPE_FRAME_STATE);
        EXPECT_EQ(xrWaitFrame(client.session, nullptr, &state), XR_SUCCESS);
      });
      EXPECT_EQ(client.begin(), XR_SUCCESS);
      EXPECT_EQ(client.end(false), XR_SUCCESS);
      next.join();
      EXPECT_EQ(client.begin(), XR_SUCCESS);
      EXPECT_EQ(client.end(false), XR_SUCCESS);
    }
  }
  EXPECT_EQ(stage.report()["violations"], Json::array());
}

TEST(Session, RealTimeWaitsForThePeriod) {
  const Stage stage(Json{{"hz", 100}, {"realtime", true}});
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  client.start();
  ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
  const auto start = std::chrono::steady_clock::now();
  const XrTime first = client.frame.predictedDisplayTime;
  for (int i = 0; i < 5; ++i) ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
  const std::chrono::nanoseconds passed = std::chrono::steady_clock::now() - start;
  EXPECT_GE(client.frame.predictedDisplayTime - first, 50000000);
  EXPECT_GE(passed.count(), 35000000);
}

}  // namespace
}  // namespace session_test
}  // namespace test_runtime::test
