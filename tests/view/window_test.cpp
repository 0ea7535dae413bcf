// `voyager view` as a person sees it, by scripts: what is shown, what is refused, what is saved.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

#include "runtime/bake/bake.h"
#include "runtime/bake/work_folder.h"
#include "runtime/base/open_source.h"
#include "tests/command_line/program.h"
#include "tests/support/needs.h"
#include "tests/support/pictures.h"
#include "tests/support/test_support.h"
#include "tests/support/x_server.h"
#include "tools/cameras.h"
#include "tools/view/bake_cache.h"

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
  std::string view(const std::string& arguments, const std::string& lines, int exit_code = 0) {
    std::ofstream(file("script.txt")) << lines;
    const Outcome result = run("voyager view " + arguments +
                               " --size 320x240 --validation --script " + file("script.txt"));
    skip_ = result.exit_code == 4 && (result.output.find("found no V") != std::string::npos ||
                                      result.output.find("only ") != std::string::npos)
                ? result.output
                : "";
    if (!skip_.empty()) return "";
    EXPECT_EQ(result.exit_code, exit_code) << result.output;
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

// Another viewer's bake of the same scene, for which a viewer waits. It ends when the file appears,
// and leaves no bake.
class BakeWhileAbsent {
 public:
  BakeWhileAbsent(const std::string& scene, const std::string& file) {
    view::make_cache_folder();
    const std::string bake = view::cached_bake(scene, *open_source(scene));
    const BakeInParts defaults;
    auto work = std::make_unique<WorkFolder>(
        view::work_folder(bake), bake_request({scene}, defaults.quality, defaults.chunk_bytes),
        true, true);
    thread_ = std::jthread([work = std::move(work), file](const std::stop_token& ended) mutable {
      while (!ended.stop_requested() && !std::filesystem::exists(file))
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      work.reset();
    });
  }

 private:
  std::jthread thread_;
};

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
// that the window has had; a broken file that is dropped changes nothing, and is told. A path is
// repeated from the cameras that are saved with it.
TEST_F(ViewWindow, ShowsWhatRenderDrawsThroughResizesAndABrokenFile) {
  const std::string output =
      view(file("city.voy"),
           "loaded\npanel off\nstill\nbookmark\npicture " + file("a.png") +
               "\nsize 200 150\nframes 3\nturn 10 3\nstill\nbookmark\npicture " + file("b.png") +
               "\nopen " + file("broken.ply") + "\nframes 5\nbaked\npicture " + file("c.png") +
               "\npath " + file("path") + " 3\nsave " + file("saved.json") + "\n",
           2);
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
  EXPECT_LE(largest_difference(read_png(file("path/0001.png")), rendered("path/cameras.json", 1)),
            kRounding);
}

// A flat scene is drawn at once, and its bake takes its place; the next time the bake is found. A
// bake that was damaged meanwhile is made anew.
TEST_F(ViewWindow, AFlatSceneIsShownAndBakedOnce) {
  const std::string scene = file("city.ply"), flat = file("flat.png"), baked = file("baked.png"),
                    lines = "loaded\npanel off\npicture " + flat +
                            "\nbaked\nstill\nbookmark\npicture " + baked + "\nsave " +
                            file("flat.json") + "\n";
  const std::string output = [&] {
    // Nothing else makes sure that the scene is drawn before its bake is there.
    const BakeWhileAbsent other(scene, flat);
    return view(scene, lines);
  }();
  if (!skip_.empty()) VOYAGER_SKIP_WITHOUT(VULKAN, skip_);
  EXPECT_TRUE(has(output, "city.ply: it is shown after")) << output;
  EXPECT_TRUE(has(output, "city.ply: its bake is shown after")) << output;
  EXPECT_LE(largest_difference(read_png(baked), rendered("flat.json", 0)), 1);
  const std::string again = view(file("city.ply"), lines);
  EXPECT_FALSE(has(again, "it is shown")) << again;
  EXPECT_TRUE(has(again, "its bake is shown")) << again;
  for (const auto& entry : std::filesystem::directory_iterator(file("cache/voyager")))
    std::filesystem::resize_file(entry.path(), entry.file_size() / 2);
  const std::string damaged = view(file("city.ply"), "loaded\nbaked\nstill\n");
  EXPECT_TRUE(has(damaged, "the bake that was kept is of no use, and is made anew")) << damaged;
  EXPECT_TRUE(has(damaged, "its bake is shown")) << damaged;
}

// Another scene is looked at from its own first view, whatever bookmarks there are; so it is after
// a move to where nothing can be drawn from. An error that is still measured is not told of it.
TEST_F(ViewWindow, AnotherSceneHasAHomeOfItsOwnAndNoErrorOfTheLast) {
  write_bytes(file("few.ply"), first_rows(file_bytes(file("city.ply")), 1500, 100));
  const std::string output =
      view(file("city.voy"), "loaded\nbookmark\nmeasure\nopen " + file("few.ply") +
                                 "\nloaded\nbookmark\nmove 1e300 0 0\nframes 2\nbookmark\n" +
                                 "still\nsave " + file("homes.json") + "\n");
  if (!skip_.empty()) VOYAGER_SKIP_WITHOUT(VULKAN, skip_);
  const auto homes = tools::read_cameras(file("homes.json"));
  ASSERT_EQ(homes.size(), 3u);
  const auto same_place = [&](size_t a, size_t b) {
    return std::ranges::equal(homes[a].pose.position, homes[b].pose.position);
  };
  EXPECT_FALSE(same_place(0, 1));
  EXPECT_TRUE(same_place(1, 2));
  const size_t told = output.find("against the truth");
  EXPECT_TRUE(told == std::string::npos || told < output.find("few.ply: it is shown")) << output;
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
  // Its bake may be there before a frame of the flat scene.
  EXPECT_TRUE(has(output, "city.splat: it is shown") ||
              has(output, "city.splat: its bake is shown"))
      << output;
  const Picture a = read_png(side), b = read_png(detail), c = read_png(error);
  EXPECT_EQ(largest_difference(a, b, 0, 158), 0);  // the line is at 160
  EXPECT_EQ(largest_difference(a, c, 0, 158), 0);
  EXPECT_GT(largest_difference(a, b, 162, 320), 100);
  EXPECT_GT(largest_difference(b, c, 162, 320), 100);
}

// Nobody looks at the messages of a script: what was not done is its exit code. Nothing of this
// waits for a scene that does not come.
TEST_F(ViewWindow, WhatAScriptDidNotDoIsItsExitCode) {
  const std::string city = file("city.voy"), picture = " --screenshot " + file("none.png");
  write_bytes(file("half.voy"), file_bytes(city).substr(0, file_bytes(city).size() / 2));
  std::ofstream(file("over.txt")) << "loaded\nsave " << city << "\nopen " << file("absent") << "\n";
  std::ofstream(file("path.txt")) << "loaded\npath " << file("no_path") << " 3\n";
  const struct {
    std::string arguments;
    int exit_code;
    std::string names;
  } cases[] = {
      {file("absent.ply") + picture, 2, "absent.ply"},
      {file("half.voy") + " --frames 1", 2, "half.voy: offset"},
      {city + " --budget 0.001" + picture, 4, "memory budget"},
      {picture, 1, "none.png: found no scene"},
      {city + " --script " + file("over.txt"), 1, "over.txt: found 1 refused"},
      {city + " --script " + file("path.txt"), 1, "no bookmarks"},
  };
  for (const auto& each : cases) {
    const Outcome result =
        run_shell("timeout 60 " + program("voyager view --quiet --size 64x48 " + each.arguments));
    if (has(result.output, "found no V")) VOYAGER_SKIP_WITHOUT(VULKAN, result.output);
    EXPECT_EQ(result.exit_code, each.exit_code) << each.arguments << "\n" << result.output;
    EXPECT_TRUE(has(result.output, each.names)) << each.arguments << "\n" << result.output;
    EXPECT_FALSE(std::filesystem::exists(file("none.png"))) << each.arguments;
  }
  EXPECT_EQ(file_bytes(city).substr(0, 3), file_bytes(file("half.voy")).substr(0, 3));
}

// A picture without it is not what was asked for.
TEST_F(ViewWindow, DoesNotWaitForAChunkThatCannotBeRead) {
  std::string bytes = file_bytes(file("city.voy"));
  const size_t middle = bytes.size() / 2;
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(middle), bytes.size() / 8, '\0');
  write_bytes(file("damaged.voy"), bytes);
  const Outcome result =
      run_shell("timeout 60 " + program("voyager view --quiet --size 64x48 --tau 0 " +
                                        file("damaged.voy") + " --screenshot " + file("hole.png")));
  if (has(result.output, "found no V")) VOYAGER_SKIP_WITHOUT(VULKAN, result.output);
  EXPECT_EQ(result.exit_code, 3) << result.output;
  EXPECT_TRUE(has(result.output, "could not be read")) << result.output;
  EXPECT_FALSE(std::filesystem::exists(file("hole.png")));
}

// Also while it bakes: nothing of the bake is left.
TEST_F(ViewWindow, ASignalEndsItAsClosingDoes) {
  const std::string log = file("signal.log");
  const Outcome result = run_shell(
      program("voyager view --size 64x48 " + file("whole.ply")) + " 2> " + log +
      " & viewer=$!; while kill -0 $viewer 2> /dev/null && ! grep -q shown " + log +
      "; do sleep 0.02; done; kill -TERM $viewer; wait $viewer; echo ended $?; cat " + log);
  if (has(result.output, "found no V")) VOYAGER_SKIP_WITHOUT(VULKAN, result.output);
  EXPECT_TRUE(has(result.output, "ended 0")) << result.output;
  std::error_code none;  // it was ended before there was a cache
  for (const auto& entry : std::filesystem::directory_iterator(file("cache/voyager"), none))
    EXPECT_EQ(entry.path().extension(), ".voy");
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
  const std::pair<std::string, std::string> lines[] = {
      {"tau -5", "from 0"},        {"milliseconds -3", "from 0"},
      {"line -4", "from 0 to 1"},  {"background 0 -4 2", "-4"},
      {"exposure 1e9", "1e9"},     {"frames 0", "from 1"},
      {"loaded extra", "1 words"}, {"budget -1", "found -1"},
      {"path x 1", "from 2"},      {"right left", "settings|detail"}};
  for (const auto& [line, names] : lines) {
    std::ofstream(file("line.txt")) << line << "\n";
    const Outcome result = run("voyager view --script " + file("line.txt"));
    EXPECT_EQ(result.exit_code, 2) << line << "\n" << result.output;
    EXPECT_TRUE(has(result.output, "line.txt: line 1: " + line + ": found ")) << result.output;
    EXPECT_TRUE(has(result.output, names)) << result.output;
  }
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
