// Frames of the splats alone, whatever the modes; silence under validation; refusals.
#include "tests/vulkan_host/host_run.h"

namespace voyager::test {
namespace {

TEST_F(VulkanHost, WithoutMeshesEachFrameIsWhatVoyagerRenders) {
  ASSERT_EQ(run("voyager render " + file("city.voy") + " --cameras " + file("cameras.json") +
                " --all -o " + file("reference"))
                .exit_code,
            0);
  for (const std::string modes :
       {"--sync auto", "--sync host", "--sharing host", "--depth standard", "--composite test"}) {
    expect_success(host("--no-mesh --frames " + std::to_string(kCameras + 2) + " -o " +
                        file("frames") + " " + modes));
    for (int i = 0; i < kCameras + 2; ++i)
      EXPECT_LE(largest_difference(read_png(numbered("frames", i, "png")),
                                   read_png(numbered("reference", i % kCameras, "png"))),
                1)
          << modes << ", frame " << i;
  }
}

// Each frame has another size than the one before: a new target, from the first to the last.
TEST_F(VulkanHost, ValidationHasNothingToSay) {
  const Outcome probe = run(host("--frames 1 --validation -o " + file("validated")));
  if (probe.output.find("found no VK_LAYER_KHRONOS_validation") != std::string::npos)
    GTEST_SKIP() << probe.output;
  for (const std::string modes :
       {"--frames 200", "--frames 25 --sync host", "--frames 25 --sharing host",
        "--frames 25 --composite test --depth standard", "--frames 25 --no-mesh",
        "--frames 25 --srgb --depth standard"}) {
    const Outcome result =
        run(host("--validation --write-depth -o " + file("validated") + " " + modes));
    EXPECT_EQ(result.exit_code, 0) << modes << "\n" << result.output;
    EXPECT_EQ(result.output.find("validation: "), std::string::npos) << modes << "\n"
                                                                     << result.output;
  }
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

// With the exit code, on one line that names what is wrong.
TEST_F(VulkanHost, RefusalsAreOneLine) {
  write_bytes(file("bad.json"), "[{\"width\": 8, \"height\": 8}]");
  write_bytes(file("bad.gltf"), R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
      "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 7}}]}]})");
  const std::string out = " -o " + file("refused");
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
      {host("--frames 1 --mesh-at 0,0,0,0" + out), 1, "--mesh-at"},
      {host("--frames 1 --sharing host --sync binary" + out), 1, "sync"},
      {host("--frames 1" + out, "absent.json"), 2, "absent.json"},
      {host("--frames 1" + out, "bad.json"), 2, "bad.json: camera 0"},
      {host("--frames 1 --mesh " + file("absent.gltf") + out), 2, "absent.gltf"},
      {host("--frames 1 --mesh " + file("bad.gltf") + out), 2, "bad.gltf: POSITION"},
      {"vulkan_host " + file("absent.voy") + " --offscreen --frames 1 --camera-file " +
           file("cameras.json") + out,
       2, "absent.voy"},
      {host("--frames 1 --budget 0.001" + out), 4, "budget"},
      {host("--frames 1 --device Nonesuch" + out), 4, "Nonesuch"},
      {host("--frames 1 -o /dev/null/frames"), 4, "/dev/null"},
  };
  for (const auto& each : cases) {
    const Outcome result = run(each.command + " 2>&1 >/dev/null");
    EXPECT_EQ(result.exit_code, each.exit_code) << each.command << "\n" << result.output;
    EXPECT_NE(result.output.find(each.names), std::string::npos) << each.command << "\n"
                                                                 << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
  }
  EXPECT_FALSE(std::filesystem::exists(file("refused/0000.png")));
}

}  // namespace
}  // namespace voyager::test
