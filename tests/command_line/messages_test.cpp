// What the command line tells people: refusals, help, what draws, devices.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/command_line/program.h"
#include "tests/support/test_support.h"

namespace voyager::messages_test {
namespace {

using namespace voyager::test;
namespace fs = std::filesystem;

class Messages : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    set_up_failure_ = failure_of({"voyager synth city --gaussians 10000 -o " + file("c.ply"),
                                  "voyager bake " + file("c.ply") + " -o " + file("c.voy")});
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override { ASSERT_EQ(set_up_failure_, ""); }
  static std::string file(const std::string& name) { return folder_->file(name); }

  static TempFolder* folder_;
  static inline std::string set_up_failure_;
};
TempFolder* Messages::folder_ = nullptr;

struct Wrong {
  const char *command, *says;
};

// What is wrong, what was found and what is expected, on one line.
TEST_F(Messages, AWrongOptionNamesItselfAndWhatIsExpected) {
  const Wrong table[] = {
      {"render S C -o o.png --camera -1", "--camera: found -1, expected 0 to 119"},
      {"render S C -o o.png --camera 120", "--camera: found 120, expected 0 to 119"},
      {"render S C -o o --stereo --camera 119", "found 119, expected 0 to 118 with --stereo"},
      {"render S C -o o.png --camera 1.5", "--camera: found 1.5, expected a whole number"},
      {"render S C -o o.png --camera ''", "--camera: found nothing, expected a whole number"},
      {"render S C -o o.png --camera", "--camera: found no value, expected --camera I"},
      {"render S -o o.png --camera 1", "--camera: found it without --cameras, expected both"},
      {"render S -o o --all", "--all: found it without --cameras"},
      {"render S C -o o.png --camera 1 --all", "--camera: found it with --all"},
      {"render S C -o o.png --camra 1", "did you mean --camera?"},
      {"render S C -o o.png --tau 1 --tau 2", "--tau: found it more than once"},
      {"render S -o o.png --tau -0.5", "--tau: found -0.5, expected a number of pixels, 0 or more"},
      {"render S -o o.png --tau 3px", "--tau: found 3px, expected a number of pixels, 0 or more"},
      {"render S -o o.png --time-budget 0", "--time-budget: found 0, expected a number of mill"},
      {"render S -o o.png --size 1280", "--size: found 1280, expected WxH in pixels, each from 1"},
      {"render S -o o.png --size 1x16385", "--size: found 1x16385, expected WxH"},
      {"render S -o o.png --background 1,2,0", "--background: found 1,2,0, expected R,G,B"},
      {"render S -o o.png --background 1,0", "--background: found 1,0, expected R,G,B"},
      {"render S -o o.png --antialias maybe", "--antialias: found maybe, expected on|off"},
      {"render S -o o.png --supersample 0", "--supersample: found 0, expected a whole number from"},
      {"render S -o o.png --supersample 4 --lod on",
       "--supersample: found it with a cut, expected --lod off"},
      {"render S -o o.png --lod off --supersample 4 --exp lut",
       "--supersample: found it with --exp lut or half2, expected auto, exact or ex2"},
      {"render S -o o.png --lut-size 0", "--lut-size: found 0, expected a whole number from 1 to"},
      {"render S -o o.png --budget -1", "--budget: found -1, expected a number of MB above 0"},
      {"render S -o o.png --budget 0", "--budget: found 0, expected a number of MB above 0, from"},
      {"render S -o o.png --budget 1e-300", "--budget: found 1e-300, expected a number of MB"},
      {"render S -o o.png --budget 4e-324", "--budget: found 4e-324, expected a number of MB"},
      {"render S -o o.png --budget 1e-400", "--budget: found 1e-400, expected a number of MB"},
      {"render S -o o.png --budget 1e10", "--budget: found 1e10, expected a number of MB"},
      {"render S -o o.png --budget nan", "--budget: found nan, expected a number of MB above 0"},
      {"render S -o o.png --budget inf", "--budget: found inf, expected a number of MB above 0"},
      {"render S -o o.png --budget ' 5'", "--budget: found  5, expected a number of MB above 0"},
      {"render S -o o.png --time-budget 1e-300", "--time-budget: found 1e-300, expected a number"},
      {"render S -o o.png --background '1, 0,0'", "--background: found 1, 0,0, expected R,G,B"},
      {"render S -o o.png --background 1,0,0x0", "--background: found 1,0,0x0, expected R,G,B"},
      {"render S -o o.png --background nan,0,0", "--background: found nan,0,0, expected R,G,B"},
      {"render S -o o.png --backend gpu", "--backend: found gpu, expected auto|cpu|cuda|referenc"},
      {"render S", "-o: found none, expected -o FILE: image to write"},
      {"render -o o.png", "scene: found none, expected scene to draw, a .voy"},
      {"render S T -o o.png", "T: found one argument too many; scene is "},
      {"render S -out o.png", "o.png: found one argument too many; "},
      {"render S -o o.png --quiet --verbose", "--quiet: found it with --verbose"},
      {"bake S -o o.ply", "-o: found o.ply, expected a name that ends in .voy"},
      {"bake S -o o.voy --refine 0", "--refine: found 0, expected a whole number from 1 to"},
      {"bake S -o o.voy --optimize great", "--optimize: found great, expected draft, good or best"},
      {"bake S -o o.voy --optimize 0", "--optimize: found 0, expected draft, good or best, or min"},
      {"bake S -o o.voy --optimize -1",
       "--optimize: found -1, expected draft, good or best, or mi"},
      {"bake S -o o.voy --memory 1", "--memory: found 1, expected a whole number from 16 to"},
      {"bake S -o o.voy --chunk-bytes 5", "--chunk-bytes: found 5, expected a whole number from"},
      {"bake S -o o.voy --part 2/2 --step cells --work w", "--part: found 2/2, expected K/N"},
      {"bake S -o o.voy --part -2/-1 --step cells --work w", "--part: found -2/-1, expected K/N"},
      {"bake S -o o.voy --part +1/2 --step cells --work w", "--part: found +1/2, expected K/N"},
      {"bake S -o o.voy --part ' 1/2' --step cells --work w", "--part: found  1/2, expected K/N"},
      {"bake S -o o.voy --part 1/2/3 --step cells --work w", "--part: found 1/2/3, expected K/N"},
      {"bake S -o o.voy --part 1 --step cells --work w", "--part: found 1, expected K/N"},
      {"bake S -o o.voy --part 0/4294967296 --step cells --work w", "--part: found 0/4294967296,"},
      {"bake S -o o.voy --step all2", "--step: found all2, expected all|split|cells|encode|merge"},
      {"synth town --gaussians 20000 -o o.ply", "what: found town, expected city"},
      {"synth city --gaussians 5 -o o.ply", "--gaussians: found 5, expected a whole number from"},
      {"synth city --gaussians 1e5 -o o.ply", "--gaussians: found 1e5, expected a whole number"},
      {"synth city --gaussians 20000 -o o.obj", "-o: found o.obj, expected a name that ends in"},
      {"synth city --gaussians 20000 -o o.ply --seed -1", "--seed: found -1, expected a whole"},
      {"export S -o o.hier --keep 25%",
       "--keep: found -o o.hier, which holds the whole tree, expected a name that ends in"},
      {"export S -o o.ply --keep 25% --cut-camera c.json",
       "--keep: found --cut-camera, expected one of the two"},
      {"export S -o o.ply --tau 3", "--tau: found it without --cut-camera, expected both"},
      {"bench S C --json o.json --sms 0", "--sms: found 0, expected a whole number from 1 to"},
      {"bench S C --json o.json --repeat x", "--repeat: found x, expected a whole number from 1"},
      {"bench S --json o.json", "--cameras: found none, expected --cameras FILE"},
      {"info S --jsn", "did you mean --json?"},
      {"devices now", "now: found one argument too many"},
      {"rendr S -o o.png", "rendr: not a command of this version, did you mean render?"},
      {"repor S C -o o", "repor: not a command of this version, did you mean report?"},
      {"info S --json=3", "--json: found a value, expected none"},
      {"rendr S", "rendr: not a command of this version, did you mean render?"},
      {"fly --help", "fly: not a command of this version, expected one of synth, bake"},
      {"fly S", "fly: not a command of this version, expected one of synth, bake"}};
  for (const Wrong& wrong : table) {
    std::string command = wrong.command;
    for (const auto& [letter, text] : {std::pair<std::string, std::string>{" S", file("c.voy")},
                                       {" C", "--cameras " + file("c.cameras.json")}})
      if (const size_t at = command.find(letter); at != std::string::npos)
        command.replace(at + 1, 1, text);
    const Outcome outcome = run("voyager " + command);
    EXPECT_EQ(outcome.exit_code, 1) << wrong.command << "\n" << outcome.output;
    EXPECT_NE(outcome.output.find(wrong.says), std::string::npos) << wrong.command << "\n"
                                                                  << outcome.output << wrong.says;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    EXPECT_FALSE(fs::exists("o.png"));
  }
}

TEST_F(Messages, AloneItShowsTheCommandsAndAnExample) {
  const Outcome alone = run("voyager"), help = run("voyager --help");
  EXPECT_EQ(alone.exit_code, 1);
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(alone.output, help.output);
  for (const char* command :
       {"synth", "bake", "export", "info", "render", "view", "bench", "devices"})
    EXPECT_NE(help.output.find("\n  " + std::string(command) + " "), std::string::npos) << command;
  EXPECT_NE(help.output.find("voyager bake city.ply -o city.voy\n"), std::string::npos);
}

TEST_F(Messages, HelpHasTheCommonOptionsFirstInEightyColumns) {
  for (const std::string command : {"synth", "bake", "export", "info", "render", "bench"}) {
    const std::string help = run("voyager " + command + " --help").output;
    EXPECT_LT(help.find("Common options:"), help.find("\nGeneral:")) << help;
    EXPECT_NE(help.find("--quiet"), std::string::npos) << command;
    std::istringstream lines(help.substr(0, help.find("\nExample")));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 82u) << line;
  }
}

// On standard error: standard output has the name of the picture alone.
TEST_F(Messages, RenderSaysWhatDrawsAndWhereItLooksFrom) {
  const std::string render =
      "voyager render " + file("c.voy") + " --size 96x54 -o " + file("a.png") + " --backend cpu";
  const Outcome said = run_shell(program(render) + " 2>" + file("said"));
  ASSERT_EQ(said.exit_code, 0) << file_bytes(file("said"));
  EXPECT_EQ(said.output, file("a.png") + "\n");
  const std::string notes = file_bytes(file("said"));
  EXPECT_NE(notes.find("drawing with the cpu backend: CPU ("), std::string::npos) << notes;
  EXPECT_NE(notes.find("no --cameras: looking at the scene from"), std::string::npos) << notes;
  EXPECT_EQ(notes.find("warning"), std::string::npos) << notes;
}

TEST_F(Messages, QuietPrintsNothingAndVerboseTheLibrarysLog) {
  const std::string render =
      "voyager render " + file("c.voy") + " --size 96x54 -o " + file("q.png") + " ";
  EXPECT_EQ(run(render + "--quiet").output, "");
  EXPECT_TRUE(fs::exists(file("q.png")));
  EXPECT_NE(run(render + "--verbose").output.find("voyOpenScene: "), std::string::npos);
  const Outcome refused = run(render + "--quiet --camera 1");
  EXPECT_NE(refused.output.find("--camera"), std::string::npos);
}

TEST_F(Messages, AWarningSaysWhyAutoIsNotCuda) {
  const auto devices = nlohmann::json::parse(run("voyager devices --json").output);
  const Outcome drawn =
      run("voyager render " + file("c.voy") + " --size 96x54 -o " + file("w.png"));
  ASSERT_EQ(drawn.exit_code, 0) << drawn.output;
  const bool cuda = devices["auto"] == "cuda";
  EXPECT_EQ(drawn.output.find("voyager: warning: AUTO chose the CPU: ") == std::string::npos, cuda)
      << drawn.output;
  if (cuda) return;
  const std::string why = devices["devices"][0]["missing"];
  EXPECT_NE(drawn.output.find(why), std::string::npos) << drawn.output;
}

TEST_F(Messages, DevicesAreListedWithWhatTheyNeed) {
  const Outcome outcome = run("voyager devices --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const auto json = nlohmann::json::parse(outcome.output);
  std::string backends;
  for (const auto& device : json["devices"]) {
    const std::string backend = device["backend"];
    if (!backends.ends_with(backend)) backends += " " + backend;
    EXPECT_EQ(device["usable"], device["missing"].is_null()) << device;
    EXPECT_FALSE(device["needs"].get<std::string>().empty());
    if (backend == "cpu") {
      EXPECT_GT(device["threads"], 0);
      EXPECT_GT(device["memory_bytes"], 100000000);
    }
    if (backend == "cuda" && device["usable"]) {
      EXPECT_EQ(device["uuid"].get<std::string>().size(), 36u);
    }
  }
  EXPECT_EQ(backends, " cuda cpu reference");
  const std::string text = run("voyager devices").output;
  EXPECT_NE(text.find("--backend auto is " + json["auto"].get<std::string>()), std::string::npos);
}

TEST_F(Messages, SizesAreInUnitsForPeopleAndInBytesForPrograms) {
  const std::string text = run("voyager info " + file("c.voy")).output;
  EXPECT_NE(text.find(" MB\n"), std::string::npos) << text;
  EXPECT_EQ(text.find(" bytes\n"), std::string::npos) << text;
  const auto json = nlohmann::json::parse(run("voyager info --json " + file("c.voy")).output);
  EXPECT_GT(json["resident_bytes"], 1000000);
  const Outcome baked = run("voyager bake " + file("c.ply") + " -o " + file("again.voy"));
  EXPECT_NE(baked.output.find(" MB, "), std::string::npos) << baked.output;
}

// A stranger's file must not steer the terminal: each kind of name that a message repeats, with ESC
// or CSI in it.
TEST_F(Messages, NamesInFilesReachTheTerminalWithoutControlCharacters) {
  const std::string ply = "ply\nformat binary_little_endian 1.0\n";
  const std::string asset = R"({"asset":{"version":"2.0"},)";
  const auto node = [&](const std::string& uri) {
    return asset +
           R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[
      {"attributes":{"POSITION":0},"extensions":{"KHR_gaussian_splatting":{}}}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":1,"type":"VEC3"}],
      "bufferViews":[{"buffer":0,"byteLength":12}],"buffers":[{"byteLength":12,"uri":")" +
           uri + R"("}]})";
  };
  const std::pair<const char*, std::string> table[] = {
      {"type.ply", ply + "element vertex 1\nproperty \x1b[2J x\nend_header\n"},
      {"name.ply", ply + "element vertex 1\nproperty list int int \x1b[2J\nend_header\n"},
      {"element.ply", ply + "element \x1b[2J -1\nend_header\n"},
      {"comment.ply", ply + "comment \x1b[2J\nwrong \x9b[2J\n"},
      {"required.gltf", asset + R"("extensionsRequired":["\u001b[2J\u009b[2J"]})"},
      {"beside.gltf", node("\\u001b[2J.bin")},
      {"outside.gltf", node("../%1b[2J.bin")},
      {"scheme.gltf", node("http://\\u009b[2J")},
      {"tileset.json", R"({"asset":{"version":"1.1"},"geometricError":1,"root":{"geometricError":0,
        "boundingVolume":{"sphere":[0,0,0,1]},"content":{"uri":"\u001b[2J.glb"}}})"}};
  for (const auto& [name, text] : table) {
    write_bytes(file(name), text);
    const Outcome done = run("voyager convert " + file(name) + " -o " + file("out.ply"));
    EXPECT_NE(done.exit_code, 0) << name;
    EXPECT_NE(done.output.find("[2J"), std::string::npos) << name << ": " << done.output;
    for (const char* control : {"\x1b", "\x9b"})
      EXPECT_EQ(done.output.find(control), std::string::npos) << name << ": " << done.output;
  }
}

}  // namespace
}  // namespace voyager::messages_test
