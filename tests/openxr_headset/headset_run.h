#pragma once
// A small city, and samples/openxr_headset in it on the test runtime, which a script drives.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/command_line/program.h"
#include "tests/support/needs.h"
#include "tests/support/pictures.h"
#include "tests/support/test_support.h"

namespace voyager::test {

using Json = nlohmann::json;

class Headset : public ::testing::Test {
 protected:
  // What fails here is asserted in SetUp: a suite that does not set up skips its tests.
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    for (const std::string& step :
         {"voyager synth city --gaussians 10000 --sh-degree 1 -o " + file("city.ply"),
          "voyager bake " + file("city.ply") + " -o " + file("city.voy")}) {
      const Outcome result = run(step);
      if (result.exit_code != 0) set_up_failure_ += step + "\n" + result.output;
    }
    use_test_runtime();
    probe_ = run(headset("--frames 1"));
  }
  static void TearDownTestSuite() { delete folder_; }

  void SetUp() override {
    ASSERT_EQ(set_up_failure_, "");
    use_test_runtime();
    if (probe_.exit_code == 4 && probe_.output.find("found no Vulkan") != std::string::npos)
      VOYAGER_SKIP_WITHOUT(VULKAN, probe_.output);
    ASSERT_EQ(probe_.exit_code, 0) << probe_.output;
  }
  static void use_test_runtime() {
    setenv("XR_RUNTIME_JSON", VOYAGER_BIN_DIR "/../lib/voyager_test_runtime.json", 1);
    write_script({});
  }

  // Megabytes that hold the top of the city's tree and not all of it. A GPU's slots are larger.
  static double small_budget() {
    return probe_.output.find("backend cuda") != std::string::npos ? 1.5 : 0.5;
  }

  static std::string file(const std::string& name) { return folder_->file(name); }
  static std::string headset(const std::string& rest) {
    return "openxr_headset " + file("city.voy") + " --camera-file " + file("city.cameras.json") +
           " " + rest;
  }

  // What the runtime does; small images and a report unless it says otherwise.
  static void write_script(Json script) {
    if (!script.contains("recommended")) script["recommended"] = {96, 72};
    script["report"] = file("report.json");
    write_bytes(file("script.json"), script.dump());
    setenv("VOYAGER_TEST_RUNTIME_SCRIPT", file("script.json").c_str(), 1);
  }

  static Json read_json(const std::string& name) {
    std::ifstream source(file(name));
    const Json json = Json::parse(source, nullptr, false);
    return json.is_discarded() ? Json::object() : json;
  }

  // Runs to its end, and the runtime saw no rule broken; what it printed.
  static std::string expect_well_behaved(const Json& script, const std::string& options) {
    write_script(script);
    std::remove(file("report.json").c_str());
    const Outcome result = run(headset(options));
    EXPECT_EQ(result.exit_code, 0) << script << " " << options << "\n" << result.output;
    const Json report = read_json("report.json");
    EXPECT_EQ(report.value("violations", Json()), Json::array()) << script << " " << options;
    const Json states = report.value("states", Json::array());
    EXPECT_EQ(states.empty() ? Json() : states.back()["state"], "XR_SESSION_STATE_EXITING")
        << script;
    return result.output;
  }
  static uint64_t counted(const std::string& what) {
    return read_json("report.json")["counts"].value(what, uint64_t{0});
  }

  // view: 0 left, 1 right, with quad views 2 left inner, 3 right inner.
  static Picture view_picture(const std::string& name, int frame, int view) {
    constexpr const char* kViews[] = {"L", "R", "L_inner", "R_inner"};
    char text[32];
    std::snprintf(text, sizeof text, "/%04d_%s.png", frame, kViews[view]);
    return read_png(file(name) + text);
  }
  static Picture eye_picture(const std::string& name, int frame, char eye) {
    return view_picture(name, frame, eye == 'L' ? 0 : 1);
  }

  // Each of these frames, of 2 views or with quad views 4, is what `voyager render` makes of the
  // cameras that were written with them, within `most` of 255.
  static void expect_rendered(const std::string& name, int frames, float most,
                              const std::string& what, int views = 2) {
    ASSERT_EQ(read_json(name + "/cameras.json").size(), static_cast<size_t>(views * frames))
        << what;
    const Outcome result = run("voyager render " + file("city.voy") + " --cameras " + file(name) +
                               "/cameras.json --stereo --all -o " + file("reference"));
    ASSERT_EQ(result.exit_code, 0) << what << result.output;
    for (int i = 0; i < views * frames; ++i) {
      char text[32];
      std::snprintf(text, sizeof text, "/%04d.png", i);
      EXPECT_LE(largest_difference(view_picture(name, i / views, i % views),
                                   read_png(file("reference") + text)),
                most)
          << what << ", image " << i;
    }
  }

  static TempFolder* folder_;

 private:
  static inline std::string set_up_failure_;
  static inline Outcome probe_;
};
inline TempFolder* Headset::folder_ = nullptr;

}  // namespace voyager::test
