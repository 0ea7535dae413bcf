// A bake that goes on in a work folder, of an input that refers to other files.
#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/command_line/program.h"
#include "tests/support/test_support.h"

namespace voyager::side_files_test {
namespace {

using namespace voyager::test;

uint32_t word_at(const std::string& bytes, size_t at) {
  uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

// A .glb as a .gltf with its bytes beside it.
void split_glb(const std::string& glb, const TempFolder& folder) {
  const std::string bytes = file_bytes(glb);
  const size_t json_bytes = word_at(bytes, 12), binary = 20 + json_bytes;
  auto json = nlohmann::json::parse(bytes.substr(20, json_bytes));
  json["buffers"][0]["uri"] = "city.bin";
  write_bytes(folder.file("city.gltf"), json.dump());
  write_bytes(folder.file("city.bin"), bytes.substr(binary + 8, word_at(bytes, binary)));
}

TEST(SideFiles, AWorkFolderNoticesThatOneChanged) {
  const TempFolder folder;
  ASSERT_EQ(
      failure_of({"voyager synth city --gaussians 10000 --sh-degree 0 -o " + folder.file("c.ply"),
                  "voyager convert " + folder.file("c.ply") + " -o " + folder.file("c.glb")}),
      "");
  split_glb(folder.file("c.glb"), folder);
  const std::string bake = "voyager bake " + folder.file("city.gltf") + " -o " +
                           folder.file("city.voy") + " --step split --work " + folder.file("work");
  ASSERT_EQ(failure_of({bake, bake}), "");
  const std::filesystem::path binary = folder.file("city.bin");
  last_write_time(binary, last_write_time(binary) + std::chrono::seconds(5));
  const Outcome changed = run(bake);
  EXPECT_EQ(changed.exit_code, 2) << changed.output;
}

}  // namespace
}  // namespace voyager::side_files_test
