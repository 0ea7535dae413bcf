// Scenes streamed from a server: a real one, which goes and comes back, and one that answers as a
// test says.
#include <chrono>
#include <filesystem>
#include <optional>

#include "runtime/frame/open_streamed.h"
#include "runtime/frame/whole_tree.h"
#include "tests/command_line/program.h"
#include "tests/http/http_test.h"
#include "tests/http/nginx.h"
#include "tests/support/is_cut.h"
#include "tests/support/render_scene.h"

namespace voyager::streaming_test {
namespace {

using namespace test;

class HttpStreaming : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = new TempFolder;
    const std::string city = made_->file("city.");
    failure_ = failure_of({"voyager synth city --gaussians 60000 --sh-degree 1 -o " + city + "ply",
                           "voyager bake " + city + "ply -o " + city + "voy",
                           render(city + "voy", "-o " + city + "pfm")});
  }
  static void TearDownTestSuite() { delete made_; }
  void SetUp() override {
    VOYAGER_NEEDS_NGINX();
    ASSERT_EQ(failure_, "");
    for (const char* name : {"city.voy", "city.pfm"})
      std::filesystem::copy(made_->file(name), local(name));
  }
  static std::string render(const std::string& scene, const std::string& rest) {
    return "voyager render " + scene + " --cameras " + made_->file("city.cameras.json") +
           " --backend cpu --camera 10 --size 96x54 " + rest;
  }
  std::string local(const std::string& name) const { return nginx_.folder("files/" + name); }

  Nginx nginx_;

 private:
  static inline TempFolder* made_ = nullptr;
  static inline std::string failure_;
};

TEST_F(HttpStreaming, AFrameThatWaitsIsThatOfTheFile) {
  ASSERT_EQ(nginx_.start("limit_rate 1m;"), "");
  const Outcome drawn =
      run(render(nginx_.url("city.voy"), "--budget 40 --wait-resident on -o " + local("far.pfm")));
  ASSERT_EQ(drawn.exit_code, 0) << drawn.output;
  EXPECT_TRUE(file_bytes(local("far.pfm")) == file_bytes(local("city.pfm")));
  // More than a machine of two cores has threads for: each waits for answers most of the time.
  const size_t connections = different_first_words(nginx_.requests(1));
  EXPECT_GT(connections, 4u);
  EXPECT_LE(connections, http::Options{}.connections);
}

// In this process, and quick to give up.
struct Near {
  explicit Near(const std::string& url, const std::string& path)
      : scene(open(std::make_shared<http::Source>(url, quick()))),
        resident(load_scene(open_file_source(path), memory(), workers)),
        part(scene, *backend, {}, memory(), workers),
        whole(resident, *backend, {}, memory(), workers) {}

  std::shared_ptr<Scene> open(const std::shared_ptr<const ByteSource>& source) {
    StreamingDesc desc;
    desc.first_bytes = 0;
    return open_streamed(source, desc, *backend, memory(), workers);
  }
  static std::pmr::memory_resource* memory() { return std::pmr::get_default_resource(); }

  Workers workers{2};
  const std::unique_ptr<Backend> backend = create_cpu_backend();
  const std::shared_ptr<Scene> scene;
  const std::shared_ptr<const Scene> resident;
  View part, whole;
  FrameInput input = frame_input(look({0, -1.7, -22}, {0, -1.6, 0}, 96, 54, 70), 1);
};

// At 500 kB/s, so that it is in flight when the server goes. On a busy machine all may have come
// by then: then once more.
TEST_F(HttpStreaming, AServerThatComesBackIsGoneOnWith) {
  std::optional<Near> near;
  const auto draw = [&] {
    const Frame frame = test::render(near->part, near->input);
    EXPECT_TRUE(is_cut(*whole_tree(*near->resident), frame.cut));
    std::this_thread::sleep_for(10ms);
    return frame.stats.missing;
  };
  for (int attempt = 0; attempt < 10; ++attempt) {
    ASSERT_EQ(
        attempt == 0 ? nginx_.start("limit_rate 500k;") : nginx_.start_again("limit_rate 500k;"),
        "");
    near.emplace(nginx_.url("city.voy"), local("city.voy"));
    const uint64_t before = near->scene->stream->counters().bytes_read;
    for (int i = 0; i < 500 && near->scene->stream->counters().bytes_read == before; ++i) draw();
    nginx_.stop();
    if (draw() > 0) break;
  }
  // Not for longer: after some tries in a row a frame that waits gives up.
  const auto stopped = std::chrono::steady_clock::now();
  for (int i = 0; i < 30 && std::chrono::steady_clock::now() - stopped < 400ms; ++i)
    EXPECT_GT(draw(), 0u);
  ASSERT_EQ(nginx_.start_again(""), "");
  near->input.wait_resident = true;
  expect_same_bits(test::render(near->part, near->input), test::render(near->whole, near->input));
}

// What is wanted is refused, for good or for now, once the scene is open: a frame that does not
// wait is drawn, one that waits says why it cannot be, and nobody asks for each chunk.
TEST_F(HttpStreaming, AServerThatRefusesIsNotWaitedForLong) {
  for (const auto& [status, expected] :
       {std::pair("404", ErrorCode::file_not_found), {"503", ErrorCode::io_transient}}) {
    SCOPED_TRACE(status);
    ASSERT_EQ(nginx_.start(), "");
    Near near(nginx_.url("city.voy"), local("city.voy"));
    nginx_.stop();
    const size_t before = nginx_.requests(1).size();
    ASSERT_EQ(nginx_.start_again("location / { return " + std::string(status) + "; }"), "");
    EXPECT_GT(test::render(near.part, near.input).stats.missing, 0u);
    near.input.wait_resident = true;
    const auto begin = std::chrono::steady_clock::now();
    expect_error(expected, "found status " + std::string(status),
                 [&] { test::render(near.part, near.input); });
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 30s);
    EXPECT_LT(nginx_.requests(before + 1).size(), before + 200);
    nginx_.stop();
  }
}

}  // namespace
}  // namespace voyager::streaming_test
