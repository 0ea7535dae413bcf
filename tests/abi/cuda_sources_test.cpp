// What CUDA's sources must not do, and no test on one device would see.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace cuda_sources_test {
namespace {

struct Line {
  std::string file;  // relative to the source folder
  std::string text;  // without its comment
};

std::vector<Line> lines_below(const std::string& folder) {
  namespace fs = std::filesystem;
  const fs::path root = VOYAGER_SOURCE_DIR;
  std::vector<Line> lines;
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream file(entry.path());
    for (std::string text; std::getline(file, text);)
      lines.push_back({fs::relative(entry.path(), root).string(), text.substr(0, text.find("//"))});
  }
  return lines;
}

TEST(CudaSources, KernelsAreLaunchedWhereLaunchesAreChecked) {
  size_t launches = 0;
  for (const Line& line : lines_below("cuda")) {
    launches += line.text.find("launch_kernel(") != std::string::npos;
    if (line.file == "cuda/device/launch.cuh") continue;
    EXPECT_EQ(line.text.find("<<<"), std::string::npos) << line.file << ": " << line.text;
    EXPECT_EQ(line.text.find("cudaLaunchKernel"), std::string::npos) << line.file;
  }
  EXPECT_GT(launches, 30u);
}

// What lives as long as the process is the same for all devices, or is kept for each.
TEST(CudaSources, NoStaticIsOneDevices) {
  const std::regex variable(R"(^\s*(inline\s+)?static\s+(?!constexpr)[^()]*(;|=|\{))");
  const std::regex known(R"(PerDevice<|= driver_function<|= nvtxDomainCreateA)");
  size_t seen = 0;
  for (const Line& line : lines_below("cuda")) {
    if (line.text.find("static") == std::string::npos || !std::regex_search(line.text, variable))
      continue;
    ++seen;
    EXPECT_TRUE(std::regex_search(line.text, known)) << line.file << ": " << line.text;
  }
  EXPECT_GE(seen, 3u);
}

// By name, what spins or copies to memory that is not pinned. Events that a host waits for are
// tested on a device.
TEST(CudaSources, AFramesWaitsDoNotSpin) {
  const std::regex spins(
      R"(cuda(Stream|Device)Synchronize\(|cudaMemcpy(2D)?\(|DeviceScheduleSpin)");
  const std::set<std::string> others = {
      "cuda/device/buffer.h",       // what a view or a scene begins with
      "cuda/device/upload_made.h",  // a scene
      "cuda/scene/device_scene.cpp",
      "cuda/stream/device_pool.cpp",        // the room of a pool, which its frames have ended for
      "cuda/device/stream.h",               // the end of a stream
      "cuda/search/exhaustive_search.cpp",  // a cut that somebody wants to have
      "cuda/search/partitioned_search.cpp",
      "cuda/search/sweep_search.cpp",
      "cuda/splat/baseline.cpp",  // waits as 3DGS does
      "cuda/train/node_trainer.cpp",
  };
  std::set<std::string> seen;
  for (const Line& line : lines_below("cuda"))
    if (std::regex_search(line.text, spins)) seen.insert(line.file);
  EXPECT_EQ(seen, others);
}

}  // namespace
}  // namespace cuda_sources_test
