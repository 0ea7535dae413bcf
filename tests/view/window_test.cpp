// `voyager view` as a person sees it, by scripts: what is shown, what is refused, what is saved.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/command_line/program.h"
#include "tests/support/needs.h"
#include "tests/support/pictures.h"
#include "tests/support/test_support.h"
#include "tests/support/x_server.h"

namespace voyager::test {
namespace view_window_test {
namespace {

class ViewWindow : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    set_up_failure_ =
        failure_of({"voyager synth city --gaussians 10000 --sh-degree 0 -o " + file("whole.ply")});
    if (!set_up_failure_.empty()) return;
    write_bytes(file("city.ply"), first_rows(file_bytes(file("whole.ply")), 10000, 1500));
    set_up_failure_ =
        failure_of({"voyager bake " + file("city.ply") + " -o " + file("city.voy"),
                    "voyager convert " + file("city.ply") + " -o " + file("city.splat")});
    std::ofstream(file("broken.ply")) << file_bytes(file("city.ply")).substr(0, 5000);
    server_ = new XServer;
  }
  static void TearDownTestSuite() {
    delete server_;
    delete folder_;
  }

  void SetUp() override {
    ASSERT_EQ(set_up_failure_, "");
    if (server_->display().empty()) VOYAGER_SKIP_WITHOUT(VULKAN, "no Xvfb");
    ASSERT_EQ(::setenv("DISPLAY", (":" + server_->display()).c_str(), 1), 0);
    ASSERT_EQ(::setenv("XDG_CACHE_HOME", file("cache").c_str(), 1), 0);
  }

  static std::string file(const std::string& name) { return folder_->file(name); }

  // A .ply with fewer rows: small, so that its bake is quick.
  static std::string first_rows(std::string ply, size_t count, size_t wanted) {
    const std::string end = "end_header\n", before = "element vertex " + std::to_string(count);
    const size_t header = ply.find(end) + end.size();
    const size_t rows = (ply.size() - header) / count * wanted;
    ply.resize(header + rows);
    return ply.replace(ply.find(before), before.size(), "element vertex " + std::to_string(wanted));
  }

  // Runs the lines under the validation layer. Its output, or a skip or failure.
  std::string view(const std::string& arguments, const std::string& lines) {
    std::ofstream(file("script.txt")) << lines;
    const Outcome result = run("voyager view " + arguments +
                               " --size 320x240 --validation --script " + file("script.txt"));
    skip_ = result.exit_code == 4 && (result.output.find("found no V") != std::string::npos ||
                                      result.output.find("only ") != std::string::npos)
                ? result.output
                : "";
    if (!skip_.empty()) return "";
    EXPECT_EQ(result.exit_code, 0) << result.output;
    EXPECT_EQ(result.output.find("validation: "), std::string::npos) << result.output;
    return result.output;
  }

  static Picture rendered(const std::string& cameras, int index) {
    const Outcome result =
        run("voyager render " + file("city.voy") + " --cameras " + file(cameras) + " --camera " +
            std::to_string(index) + " -o " + file("rendered.png"));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return read_png(file("rendered.png"));
  }

  static const std::string& set_up_failure() { return set_up_failure_; }

  std::string skip_;

 private:
  static inline TempFolder* folder_ = nullptr;
  static inline XServer* server_ = nullptr;
  static inline std::string set_up_failure_;
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// Between two columns.
float largest_difference(const Picture& a, const Picture& b, uint32_t from, uint32_t to) {
  if (a.width != b.width || a.height != b.height || a.width < to) return 255;
  float most = 0;
  for (uint32_t y = 0; y < a.height; ++y)
    for (uint32_t i = 3 * (y * a.width + from); i < 3 * (y * a.width + to); ++i)
      most = std::max(most, std::abs(a.values[i] - b.values[i]));
  return most;
}

// The scene's name may have spaces, and so may the picture's.
TEST_F(ViewWindow, ClosesAfterSomeFramesWithTheLastOfThem) {
  const std::string picture = file("a picture.png");
  const Outcome found = run("voyager view " + file("city.voy") +
                            " --size 320x240 --frames 3 --screenshot \"" + picture + "\"");
  if (found.exit_code == 4) VOYAGER_SKIP_WITHOUT(VULKAN, found.output);
  EXPECT_EQ(found.exit_code, 0) << found.output;
  EXPECT_EQ(read_png(picture).width, 320u);
  EXPECT_EQ(run("voyager view --screenshot a.png --script b.txt").exit_code, 1);
}

// What the window shows is what `voyager render` draws of the cameras that it saves, in every size
// that the window has had; a broken file that is dropped changes nothing, and is told.
TEST_F(ViewWindow, ShowsWhatRenderDrawsThroughResizesAndABrokenFile) {
  const std::string output =
      view(file("city.voy"), "loaded\npanel off\nstill\nbookmark\npicture " + file("a.png") +
                                 "\nsize 200 150\nframes 3\nturn 10 3\nstill\nbookmark\npicture " +
                                 file("b.png") + "\nopen " + file("broken.ply") +
                                 "\nframes 5\nbaked\npicture " + file("c.png") + "\npath " +
                                 file("path") + " 3\nsave " + file("saved.json") + "\n");
  if (!skip_.empty()) VOYAGER_SKIP_WITHOUT(VULKAN, skip_);
  EXPECT_TRUE(has(output, "broken.ply: offset")) << output;
  constexpr float kRounding =
      1;  // code values, which is 48 dB; equal where the backend is the same
  const Picture first = read_png(file("a.png")), second = read_png(file("b.png"));
  EXPECT_EQ(first.width, 320u);
  EXPECT_EQ(second.width, 200u);
  EXPECT_LE(largest_difference(first, rendered("saved.json", 0)), kRounding);
  EXPECT_LE(largest_difference(second, rendered("saved.json", 1)), kRounding);
  EXPECT_EQ(largest_difference(second, read_png(file("c.png"))), 0);
  EXPECT_EQ(largest_difference(second, read_png(file("path/0002.png"))), 0);
  EXPECT_GT(largest_difference(second, read_png(file("path/0000.png"))), 50);
}

// A flat scene is drawn at once, and its bake takes its place; the next time the bake is found.
TEST_F(ViewWindow, AFlatSceneIsShownAndBakedOnce) {
  const std::string lines = "loaded\npanel off\nbaked\nstill\nbookmark\npicture " +
                            file("baked.png") + "\nsave " + file("flat.json") + "\n";
  const std::string output = view(file("city.ply"), lines);
  if (!skip_.empty()) VOYAGER_SKIP_WITHOUT(VULKAN, skip_);
  EXPECT_TRUE(has(output, "city.ply: it is shown after")) << output;
  EXPECT_TRUE(has(output, "city.ply: its bake is shown after")) << output;
  EXPECT_LE(largest_difference(read_png(file("baked.png")), rendered("flat.json", 0)), 1);
  const std::string again = view(file("city.ply"), lines);
  EXPECT_FALSE(has(again, "it is shown")) << again;
  EXPECT_TRUE(has(again, "its bake is shown")) << again;
}

// Right of the line: other settings, the level of detail, and the error, which is measured. Another
// scene then takes the place of all of them.
TEST_F(ViewWindow, TheLineDividesTwoPictures) {
  const std::string side = file("settings.png"), detail = file("detail.png"),
                    error = file("error.png");
  const std::string output =
      view(file("city.voy"),
           "loaded\npanel off\ntau 1\nright settings\nright-tau 40\nstill\npicture " + side +
               "\nright detail\nstill\npicture " + detail + "\nmeasure\nstill\npicture " + error +
               "\nopen " + file("city.splat") + "\nloaded\n");
  if (!skip_.empty()) VOYAGER_SKIP_WITHOUT(VULKAN, skip_);
  EXPECT_TRUE(has(output, "dB against the truth")) << output;
  EXPECT_TRUE(has(output, "city.splat: it is shown")) << output;
  const Picture a = read_png(side), b = read_png(detail), c = read_png(error);
  EXPECT_EQ(largest_difference(a, b, 0, 158), 0);  // the line is at 160
  EXPECT_EQ(largest_difference(a, c, 0, 158), 0);
  EXPECT_GT(largest_difference(a, b, 162, 320), 100);
  EXPECT_GT(largest_difference(b, c, 162, 320), 100);
}

// A machine without a display, where nobody has to look.
class ViewOffScreen : public ViewWindow {
 protected:
  void SetUp() override {
    ASSERT_EQ(set_up_failure(), "");
    ::unsetenv("DISPLAY");
    ::unsetenv("WAYLAND_DISPLAY");
  }
};

// The pictures are those of a window: what `voyager render` draws, with the panel over it.
TEST_F(ViewOffScreen, PicturesNeedNoDisplay) {
  const std::string output =
      view(file("city.voy"), "loaded\nsize 480 200\nframes 2\nstill\nwindow " + file("panel.png") +
                                 "\npicture " + file("plain.png") + "\nbookmark\nsave " +
                                 file("off.json") + "\n");
  if (!skip_.empty()) VOYAGER_SKIP_WITHOUT(VULKAN, skip_);
  EXPECT_TRUE(has(output, "no display: drawn off screen")) << output;
  const Picture plain = read_png(file("plain.png")), panel = read_png(file("panel.png"));
  EXPECT_LE(largest_difference(plain, rendered("off.json", 0)), 1);
  constexpr uint32_t kBesidePanel = 345;
  EXPECT_GT(largest_difference(plain, panel, 0, kBesidePanel), 100);
  EXPECT_EQ(largest_difference(plain, panel, kBesidePanel, 480), 0);
}

TEST_F(ViewWindow, RefusalsAreOneLine) {
  std::ofstream(file("wrong.txt")) << "loaded\n\njump 3\n";
  std::ofstream(file("large.txt")) << "size 0 16385\n";
  const struct {
    std::string command;
    int exit_code;
    std::string names;
  } cases[] = {
      {"env -u DISPLAY -u WAYLAND_DISPLAY " + program("voyager view " + file("city.voy")), 4,
       "no display for a window (`voyager render` needs none, nor do --script and --screenshot)"},
      {program("voyager view --script " + file("wrong.txt")), 2, "wrong.txt: line 3: jump 3"},
      {program("voyager view --script " + file("large.txt")), 2, "large.txt: line 1: size 0 16385"},
      {program("voyager view --script " + file("absent.txt")), 2, "absent.txt"},
      {program("voyager view --cameras " + file("absent.json")), 2, "absent.json"},
      {program("voyager view --budget 0"), 1, "--budget"},
      {program("voyager view " + file("city.ply") + " --keep " + file("city.ply")), 1, "--keep"},
      {program("voyager view " + file("city.voy") + " --keep " + file("city.voy")), 1, "city.voy"},
  };
  for (const auto& each : cases) {
    const Outcome result = run_shell("timeout 60 " + each.command);
    EXPECT_EQ(result.exit_code, each.exit_code) << each.command << "\n" << result.output;
    EXPECT_TRUE(has(result.output, each.names)) << each.command << "\n" << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
  }
}

}  // namespace
}  // namespace view_window_test
}  // namespace voyager::test
