// A whole session through the real loader, under both validation layers.
#include "tests/openxr_runtime/client.h"

namespace test_runtime::test {
namespace {

TEST(Session, AGoodOneIsReportedClean) {
  const Stage stage(Json{{"events", {{{"frame", 20}, {"do", "exit"}}}}});
  ::setenv("XR_CORE_VALIDATION_EXPORT_TYPE", "text", 1);
  ::setenv("XR_CORE_VALIDATION_FILE_NAME", stage.file("core_validation.txt").c_str(), 1);
  {
    Client client(kAllExtensions, {"XR_APILAYER_LUNARG_core_validation"});
    VOYAGER_NEEDS_VULKAN(client);
    client.create_session();
    client.create_swapchains();
    EXPECT_TRUE(client.run(100));
    EXPECT_EQ(client.state, XR_SESSION_STATE_EXITING);
  }
  const Json report = stage.report();
  EXPECT_EQ(report["violations"], Json::array());
  EXPECT_EQ(report["remarks"], Json::array());
  EXPECT_EQ(report["counts"]["frames_ended"], 21);
  std::ifstream said(stage.file("core_validation.txt"));
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(said), {}), "");
}

}  // namespace
}  // namespace test_runtime::test
