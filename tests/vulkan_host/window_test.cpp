// The sample's window, on an X server without a screen.
#include <cstdlib>

#include "tests/support/x_server.h"
#include "tests/vulkan_host/host_run.h"

namespace voyager::test {
namespace window_test {
namespace {

TEST_F(VulkanHost, AWindowRunsToItsEndInSilence) {
  const XServer server;
  if (server.display().empty()) VOYAGER_SKIP_WITHOUT(VULKAN, "no Xvfb");
  ASSERT_EQ(::setenv("DISPLAY", (":" + server.display()).c_str(), 1), 0);
  const Outcome result =
      run("vulkan_host " + file("city.voy") + " --camera-file " + file("cameras.json") +
          " --frames 5 --validation --time-budget 40 --stats " + file("window.json"));
  if (result.output.find("found no VK_LAYER_KHRONOS_validation") != std::string::npos)
    VOYAGER_SKIP_WITHOUT(VULKAN, result.output);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(result.output.find("validation: "), std::string::npos) << result.output;
  const nlohmann::json stats = nlohmann::json::parse(file_bytes(file("window.json")));
  EXPECT_EQ(stats["frames"].size(), 5u);
  EXPECT_EQ(stats["frames"].back()["time_budget_ms"], 40);
}

}  // namespace
}  // namespace window_test
}  // namespace voyager::test
