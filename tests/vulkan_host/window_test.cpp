// The sample's window, on an X server without a screen.
#include <csignal>
#include <cstdlib>

#include "tests/vulkan_host/host_run.h"

namespace voyager::test {
namespace window_test {
namespace {

// Xvfb on a display that it finds free itself; gone with this object.
class XServer {
 public:
  XServer() {
    int ends[2];
    if (::pipe(ends) != 0) return;
    process_ = ::fork();
    if (process_ == 0) {
      ::close(ends[0]);
      const std::string fd = std::to_string(ends[1]);
      ::execlp("Xvfb", "Xvfb", "-displayfd", fd.c_str(), "-screen", "0", "1400x900x24", "-nolisten",
               "tcp", nullptr);
      ::_exit(127);
    }
    ::close(ends[1]);
    char digit = 0;
    while (::read(ends[0], &digit, 1) == 1 && digit != '\n') display_ += digit;
    ::close(ends[0]);
  }
  ~XServer() {
    if (process_ <= 0) return;
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }
  XServer(const XServer&) = delete;
  XServer& operator=(const XServer&) = delete;

  // "" where there is none.
  const std::string& display() const { return display_; }

 private:
  pid_t process_ = -1;
  std::string display_;
};

TEST_F(VulkanHost, AWindowRunsToItsEndInSilence) {
  const XServer server;
  if (server.display().empty()) VOYAGER_SKIP_WITHOUT(VULKAN, "no Xvfb");
  ASSERT_EQ(::setenv("DISPLAY", (":" + server.display()).c_str(), 1), 0);
  const Outcome result =
      run("vulkan_host " + file("city.voy") + " --camera-file " + file("cameras.json") +
          " --frames 5 --validation --stats " + file("window.json"));
  if (result.output.find("found no VK_LAYER_KHRONOS_validation") != std::string::npos)
    VOYAGER_SKIP_WITHOUT(VULKAN, result.output);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(result.output.find("validation: "), std::string::npos) << result.output;
  const nlohmann::json stats = nlohmann::json::parse(file_bytes(file("window.json")));
  EXPECT_EQ(stats["frames"].size(), 5u);
}

}  // namespace
}  // namespace window_test
}  // namespace voyager::test
