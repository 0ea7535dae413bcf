// Frames of the splats alone, whatever the modes; silence under validation; refusals.
#include <sys/stat.h>

#include "tests/vulkan_host/host_run.h"

namespace voyager::test {
namespace frames_test {
namespace {

// With cameras of one size two frames are in flight; else each frame is of a new target.
class Frames : public VulkanHost, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(
    Of, Frames, ::testing::Values("cameras.json", "steady.json"), [](const auto& each) {
      return std::string(each.param == std::string("steady.json") ? "OneSize" : "ChangingSizes");
    });

TEST_P(Frames, WithoutMeshesEachIsWhatVoyagerRenders) {
  expect_success("voyager render " + file("city.voy") + " --cameras " + file(GetParam()) +
                 " --all -o " + file("reference"));
  for (const std::string modes :
       {"--sync auto", "--sync host", "--sharing host", "--depth standard", "--composite test"}) {
    expect_success(host("--no-mesh --frames " + std::to_string(kCameras + 2) + " -o " +
                            file("frames") + " " + modes,
                        GetParam()));
    for (int i = 0; i < kCameras + 2; ++i)
      EXPECT_LE(largest_difference(read_png(numbered("frames", i, "png")),
                                   read_png(numbered("reference", i % kCameras, "png"))),
                1)
          << modes << ", frame " << i;
  }
}

TEST_P(Frames, ValidationHasNothingToSay) {
  const Outcome probe = run(host("--frames 1 --validation -o " + file("validated")));
  if (probe.output.find("found no VK_LAYER_KHRONOS_validation") != std::string::npos)
    VOYAGER_SKIP_WITHOUT(VULKAN, probe.output);
  const std::string longest =
      GetParam() == std::string("steady.json") ? "--frames 50" : "--frames 200";
  for (const std::string modes :
       {longest.c_str(), "--frames 25 --sync host", "--frames 25 --sharing host",
        "--frames 25 --composite test --depth standard", "--frames 25 --no-mesh",
        "--frames 25 --srgb --depth standard", "--frames 25 --half-rate"}) {
    const Outcome result =
        run(host("--validation --write-depth -o " + file("validated") + " " + modes, GetParam()));
    EXPECT_EQ(result.exit_code, 0) << modes << "\n" << result.output;
    EXPECT_EQ(result.output.find("validation: "), std::string::npos) << modes << "\n"
                                                                     << result.output;
  }
}

// The same triangle below so many nodes as no stack has room for.
TEST_F(VulkanHost, ADeepTreeOfNodesIsDrawn) {
  constexpr int kDeep = 300000;
  const std::string front = R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "buffers": [{"byteLength": 36, "uri": "triangle.bin"}], "nodes": [)";
  const float corners[9] = {-9, 0, -9, 9, 0, -9, 0, 9, 9};
  write_bytes(file("triangle.bin"), {reinterpret_cast<const char*>(corners), sizeof corners});
  write_bytes(file("flat.gltf"), front + R"({"mesh": 0}]})");
  std::string nodes;
  for (int i = 1; i < kDeep; ++i) nodes += R"({"children": [)" + std::to_string(i) + "]},\n";
  write_bytes(file("deep.gltf"), front + nodes + R"({"mesh": 0}]})");
  for (const std::string name : {"flat", "deep"})
    expect_success(host("--frames 1 --mesh " + file(name + ".gltf") + " -o " + file(name)));
  EXPECT_EQ(file_bytes(numbered("deep", 0, "png")), file_bytes(numbered("flat", 0, "png")));
}

TEST_F(VulkanHost, StatsSayWhatRan) {
  expect_success(
      host("--frames 3 -o " + file("frames") + " --stats " + file("stats.json") + " --tau 6"));
  std::ifstream source(file("stats.json"));
  const nlohmann::json stats = nlohmann::json::parse(source);
  EXPECT_EQ(stats["frames"].size(), 3u);
  for (const nlohmann::json& frame : stats["frames"]) {
    EXPECT_EQ(frame["tau"], 6.0);
    EXPECT_GT(frame["cut"], 0);
  }
  EXPECT_NE(stats["sharing"], "auto");
}

// With less memory than the scene takes, what the cameras need comes and goes; nothing is ever over
// the budget, and no frame waits.
TEST_F(VulkanHost, ABudgetBelowTheSceneStreams) {
  constexpr double kMegabytes = 0.5;
  expect_success(host("--frames 60 --no-mesh --tau 0.5 -o " + file("streamed") + " --stats " +
                          file("stats.json") + " --budget " + std::to_string(kMegabytes),
                      "steady.json"));
  const nlohmann::json frames = nlohmann::json::parse(file_bytes(file("stats.json")))["frames"];
  ASSERT_EQ(frames.size(), 60u);
  for (const nlohmann::json& frame : frames) {
    const nlohmann::json& streaming = frame["streaming"];
    EXPECT_LE(frame["resident_bytes"], kMegabytes * 1e6);
    EXPECT_LE(streaming["budget_bytes"], kMegabytes * 1e6);
    EXPECT_LE(streaming["resident_chunks"], streaming["slots"]);
    EXPECT_GT(frame["cut"], 0);
  }
  EXPECT_GT(frames.back()["streaming"]["arrived"], frames.front()["streaming"]["arrived"]);
  EXPECT_GT(frames.back()["streaming"]["evicted"], 0);
}

// From 3 to the least there is, where there is time to spare; to the greatest where there is none.
TEST_F(VulkanHost, TauFollowsATimeBudget) {
  for (const auto& [budget, tau] : {std::pair("1e6", 1.0), std::pair("1e-6", 60.0)}) {
    expect_success(host("--frames 40 --no-mesh -o " + file("timed") + " --stats " +
                            file("stats.json") + " --time-budget " + budget,
                        "steady.json"));
    const nlohmann::json frames = nlohmann::json::parse(file_bytes(file("stats.json")))["frames"];
    EXPECT_EQ(frames.back()["tau"], tau) << budget;
    EXPECT_EQ(frames.back()["time_budget_ms"], std::stod(budget));
  }
}

// A binary glTF of this JSON alone.
std::string glb(const std::string& json) {
  const uint32_t length = static_cast<uint32_t>(json.size());
  const uint32_t head[5] = {0x46546c67, 2, 20 + length, length, 0x4e4f534a};
  return std::string(reinterpret_cast<const char*>(head), sizeof head) + json;
}

// With the exit code, on one line that names what is wrong.
TEST_F(VulkanHost, RefusalsAreOneLine) {
  write_bytes(file("bad.json"), "[{\"width\": 8, \"height\": 8}]");
  write_bytes(file("bad.gltf"), R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
      "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 7}}]}]})");
  const std::string deep(300000, '['), asset = R"({"asset": {"version": "2.0"}, "extras": )";
  write_bytes(file("deep.json"), deep);
  write_bytes(file("deep.gltf"), asset + deep + std::string(deep.size(), ']') + "}");
  write_bytes(file("deep.glb"), glb(asset + deep));
  std::filesystem::create_directory(file("folder.gltf"));
  write_bytes(file("folder_inside.gltf"), R"({"asset": {"version": "2.0"},
      "buffers": [{"byteLength": 36, "uri": "folder.gltf"}]})");
  ASSERT_EQ(::mkfifo(file("pipe").c_str(), 0666), 0);
  std::filesystem::create_symlink("circle.json", file("circle.json"));
  namespace fs = std::filesystem;
  fs::create_directories(file("over/0002.png"));
  fs::copy(file("cameras.json"), file("over/0000.png"));
  fs::create_symlink("../cameras.json", file("over/0001.pfm"));
  write_bytes(file("in_two.bin"), std::string(36, '\0'));
  write_bytes(file("in_two.gltf"), R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
      "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "buffers": [{"byteLength": 36, "uri": "in_two.bin"}]})");
  fs::copy(VOYAGER_BIN_DIR "/../share/voyager/landmarks.gltf", file("own.gltf"));
  for (const auto& [name, size] :
       {std::pair("large.json", 64'000'001), std::pair("large.gltf", 1'000'000'001)}) {
    write_bytes(file(name), "[1");
    fs::resize_file(file(name), size);
  }
  const std::string out = " -o " + file("refused"), over = " -o " + file("over");
  const struct {
    std::string command;
    int exit_code;
    std::string names;
  } cases[] = {
      {"vulkan_host", 1, "SCENE"},
      {host(out), 1, "--frames"},
      {host("--frames 1"), 1, "-o"},
      {host("--frames 1 --composite over" + out), 1, "--composite"},
      {host("--frames 1 --tau -1" + out), 1, "--tau"},
      {host("--frames 1 --time-budget 0" + out), 1, "--time-budget"},
      {host("--frames 1 --time-budget 8 --tau 3" + out), 1, "--time-budget"},
      {"vulkan_host " + file("city.ply") +
           " --offscreen --frames 1 --time-budget 8 --camera-file " + file("cameras.json") + out,
       1, "without a tree"},
      {host("--frames 1 --mesh-at 0,0,0,0" + out), 1, "--mesh-at"},
      {host("--frames 1 --mesh-at 0,0,1" + out), 1, "--mesh-at"},
      {host("--frames 1 --mesh-at 0,0,x,1" + out), 1, "--mesh-at"},
      {host("--frames 1 --no-mesh --mesh " + file("bad.gltf") + out), 1, "--no-mesh"},
      {host("--frames 1 --budget 1e30" + out), 1, "--budget"},
      {host("--frames 1 --budget nan" + out), 1, "--budget"},
      {host("--frames 1 --budget 1e-300" + out), 1, "--budget"},
      {"vulkan_host " + file("city.voy") + " --srgb", 1, "--srgb"},
      {host("--frames 1 --sharing host --sync binary" + out), 1, "sync"},
      {host("--frames 1" + out, "absent.json"), 2, "absent.json"},
      {host("--frames 1" + out, "bad.json"), 2, "bad.json: camera 0"},
      {host("--frames 1" + out, "deep.json"), 2, "deep.json: found JSON of more than 16 levels"},
      {host("--frames 1" + out, "large.json"), 2, "large.json: found 64000001 bytes"},
      {host("--frames 1 --mesh " + file("large.gltf") + out), 2, "large.gltf: found 1000000001 b"},
      {host("--frames 1" + out, "folder.gltf"), 2, "folder.gltf: Is a directory"},
      {host("--frames 1 --mesh " + file("absent.gltf") + out), 2, "absent.gltf"},
      {host("--frames 1 --mesh " + file("bad.gltf") + out), 2, "bad.gltf: POSITION"},
      {host("--frames 1 --mesh " + file("deep.gltf") + out), 2, "deep.gltf: JSON"},
      {host("--frames 1 --mesh " + file("deep.glb") + out), 2, "deep.glb: JSON"},
      {host("--frames 1 --mesh " + file("folder.gltf") + out), 2, "folder.gltf: Is a directory"},
      {host("--frames 1 --mesh " + file("folder_inside.gltf") + out), 2, "folder_inside.gltf"},
      {"vulkan_host " + file("absent.voy") + " --offscreen --frames 1 --camera-file " +
           file("cameras.json") + out,
       2, "absent.voy"},
      {host("--frames 1 --budget 0.001" + out), 4, "budget"},
      {host("--frames 1 --device Nonesuch" + out), 4, "Nonesuch"},
      {host("--frames 1 -o /dev/null/frames"), 4, "/dev/null"},
      {host("--frames 1" + out, "pipe"), 2, "pipe: found a pipe or device"},
      {host("--frames 1 --mesh " + file("pipe") + out), 2, "pipe: found a pipe or device"},
      {"vulkan_host " + file("pipe") + " --offscreen --frames 1 --camera-file " +
           file("cameras.json") + out,
       2, "pipe: found a FIFO"},
      {host("--frames 1 --stats " + file("city.voy") + out), 1, "city.voy: found it as an output"},
      {host("--frames 1 --stats " + file("cameras.json") + out), 1, "cameras.json: found it as"},
      {host("--frames 1 --mesh " + file("in_two.gltf") + " --stats " + file("in_two.bin") + out), 1,
       "in_two.bin: found it as an output"},
      {host("--frames 1 --mesh " + file("own.gltf") + " --stats " + file("own.gltf") + out), 1,
       "own.gltf: found it as an output"},
      {host("--frames 2 --stats " + file("over/0001.png") + over), 1, "over/0001.png: found it"},
      {host("--frames 1" + over, "over/0000.png"), 1, "over/0000.png: found it as an output"},
      {host("--frames 2 --write-depth" + over), 1, "over/0001.pfm: found it as an output"},
      {host("--frames 3" + over), 4, "over/0002.png: "},
      {host("--frames 1 --stats " + file("pipe") + out), 4, "pipe: "},
      {host("--frames 1 --stats " + file("folder.gltf") + out), 4, "folder.gltf: "},
      {host("--frames 1 --stats " + file("circle.json") + out), 4,
       "circle.json: found symbolic links in a circle, expected a file"},
  };
  for (const auto& each : cases) {
    const Outcome result = run_shell("timeout 60 " + program(each.command) + " 2>&1 >/dev/null");
    EXPECT_EQ(result.exit_code, each.exit_code) << each.command << "\n" << result.output;
    EXPECT_NE(result.output.find(each.names), std::string::npos) << each.command << "\n"
                                                                 << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
  }
  EXPECT_FALSE(std::filesystem::exists(file("refused/0000.png")));
}

}  // namespace
}  // namespace frames_test
}  // namespace voyager::test
