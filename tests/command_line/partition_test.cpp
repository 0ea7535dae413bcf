// What a user says and is told of subtrees and chunks: bake --chunk-bytes, --verify, info.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "runtime/format/reader.h"
#include "tests/command_line/program.h"
#include "tests/support/test_support.h"

namespace voyager::test {
namespace partition_test {
namespace {

nlohmann::json info_of(const std::string& path) {
  const Outcome info = run("voyager info " + path + " --json");
  EXPECT_EQ(info.exit_code, 0) << info.output;
  return nlohmann::json::parse(info.output);
}

TEST(CommandLinePartition, ChunkBytesAreKeptInTheFileAndToldByInfo) {
  const TempFolder folder;
  const std::string city = folder.file("city.ply"), scene = folder.file("city.voy");
  ASSERT_EQ(run("voyager synth city --gaussians 10000 -o " + city).exit_code, 0);
  const std::string bake = "voyager bake " + city + " -o " + scene;
  size_t chunks_before = 0;
  for (const std::string bytes : {"", "1024", "65536"}) {
    const Outcome baked =
        run(bake + " --verify" + (bytes.empty() ? "" : " --chunk-bytes " + bytes));
    ASSERT_EQ(baked.exit_code, 0) << baked.output;
    EXPECT_NE(baked.output.find(", verified"), std::string::npos) << baked.output;
    const auto info = info_of(scene);
    const SceneFile file(open_file_source(scene));
    EXPECT_EQ(info["chunk_bytes"],
              bytes.empty() ? kDefaultChunkBytes : static_cast<uint32_t>(std::stoul(bytes)));
    EXPECT_EQ(info["chunks"], file.chunks().size());
    EXPECT_EQ(info["subtrees"], file.info().subtree_count);
    EXPECT_EQ(info["tiers"], file.tiers().tier_count());
    EXPECT_EQ(info["damaged_chunks"], 0);
    EXPECT_NE(file.chunks().size(), chunks_before);
    chunks_before = file.chunks().size();
  }
  const Outcome text = run("voyager info " + scene);
  EXPECT_NE(text.output.find("chunks of up to 65536 bytes"), std::string::npos) << text.output;
  EXPECT_EQ(info_of(city)["subtrees"], 0);

  for (const std::string bytes : {"0", "1023", "1048577", "-1", "many", "1024.5"}) {
    const Outcome refused = run(bake + " --chunk-bytes " + bytes);
    EXPECT_EQ(refused.exit_code, 1) << bytes;
    EXPECT_NE(refused.output.find("--chunk-bytes"), std::string::npos) << refused.output;
  }
}

TEST(CommandLineTree, TheKindOfTheTreeIsChosenAndKeptInTheFile) {
  const TempFolder folder;
  const std::string city = folder.file("city.ply"), scene = folder.file("city.voy");
  ASSERT_EQ(run("voyager synth city --gaussians 10000 --sh-degree 0 -o " + city).exit_code, 0);
  const std::string bake = "voyager bake " + city + " -o " + scene + " --verify";
  const auto tree_of = [&](const std::string& option) {
    const Outcome baked = run(bake + option);
    EXPECT_EQ(baked.exit_code, 0) << baked.output;
    return SceneFile(open_file_source(scene)).info();
  };
  EXPECT_EQ(tree_of("").tree, TreeKind::clustered);
  EXPECT_NE(run("voyager info " + scene).output.find("tree          clustered"), std::string::npos);
  EXPECT_EQ(tree_of(" --tree clustered").tree, TreeKind::clustered);
  const SceneFileInfo compatible = tree_of(" --tree hierarchicalgs");
  EXPECT_EQ(compatible.tree, TreeKind::hierarchicalgs);
  EXPECT_EQ(compatible.node_count, 2 * 10000u - 1);
  EXPECT_NE(run("voyager info " + scene + " --json").output.find("\"hierarchicalgs\""),
            std::string::npos);

  for (const std::string value : {"nonsense", "", "Clustered"}) {
    const Outcome refused = run(bake + " --tree '" + value + "'");
    EXPECT_EQ(refused.exit_code, 1) << value;
    EXPECT_NE(refused.output.find("--tree"), std::string::npos) << refused.output;
  }
}

TEST(CommandLineTree, RefiningChangesExtentsAloneAndLeavesNothingBehind) {
  const TempFolder folder;
  const std::string city = folder.file("city.ply"), plain = folder.file("plain.voy"),
                    refined = folder.file("refined.voy");
  ASSERT_EQ(run("voyager synth city --gaussians 10000 --sh-degree 0 -o " + city).exit_code, 0);
  ASSERT_EQ(run("voyager bake " + city + " -o " + plain).exit_code, 0);
  const Outcome baked = run("voyager bake " + city + " --refine 3 --verify -o " + refined);
  ASSERT_EQ(baked.exit_code, 0) << baked.output;
  EXPECT_FALSE(std::filesystem::exists(refined + ".refine"));
  const SceneFile before(open_file_source(plain)), after(open_file_source(refined));
  EXPECT_EQ(after.info().node_count, before.info().node_count);
  ASSERT_EQ(after.chunks().size(), before.chunks().size());
  size_t changed = 0;
  for (uint32_t c = 0; c < after.chunks().size(); ++c) {
    const Chunk a = before.read_chunk(c), b = after.read_chunk(c);
    ASSERT_EQ(a.node, b.node);
    ASSERT_EQ(a.sh, b.sh);
    for (size_t i = 0; i < a.records.size(); ++i) {
      ASSERT_TRUE(a.records[i].box_min == b.records[i].box_min &&
                  a.records[i].box_max == b.records[i].box_max);
      changed += a.records[i].extent != b.records[i].extent;
    }
  }
  EXPECT_GT(changed, 1000u);

  const std::string bake = "voyager bake " + city + " -o " + folder.file("no.voy") + " --refine ";
  for (const std::string value : {"0", "-1", "many", "1048577"}) {
    const Outcome refused = run(bake + value);
    EXPECT_EQ(refused.exit_code, 1) << value;
    EXPECT_NE(refused.output.find("--refine"), std::string::npos) << refused.output;
  }
  const Outcome other = run(bake + "3 --tree hierarchicalgs");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.output.find("--refine: found --tree hierarchicalgs"), std::string::npos);
  const Outcome in_parts = run(bake + "3 --work " + folder.file("work"));
  EXPECT_EQ(in_parts.exit_code, 1) << in_parts.output;
  EXPECT_NE(in_parts.output.find("--refine: found a bake in a work folder"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder.file("no.voy")));
}

TEST(CommandLinePartition, FilesOfOlderVersionsAreRefusedAndSayToBakeAgain) {
  const TempFolder folder;
  for (const std::string version : {"1", "2"}) {
    const std::string old = VOYAGER_SOURCE_DIR "/tests/fuzz/corpus/voy/version" + version + ".voy";
    const std::string bytes = file_bytes(old);
    ASSERT_FALSE(bytes.empty());
    write_bytes(folder.file("old.voy"), bytes);
    const Outcome info = run("voyager info " + folder.file("old.voy"));
    EXPECT_EQ(info.exit_code, 2) << info.output;
    for (const std::string& part :
         {std::string("old.voy"), "version " + version, std::string("bake the scene again")})
      EXPECT_NE(info.output.find(part), std::string::npos) << info.output;
  }
}

}  // namespace
}  // namespace partition_test
}  // namespace voyager::test
