// A folder of SOG files that is worth a few Gaussians costs no more, whatever its files say.
#include <gtest/gtest.h>

#include "tests/support/measured_run.h"
#include "tests/support/sog_files.h"

namespace voyager::test {
namespace sog_hostile_files_test {
namespace {

// Each file alone is worth its Gaussians; all of them would take gigabytes.
TEST(SogHostileFiles, ManyThatShareTheirImages) {
  const TempFolder folder;
  write_files(folder.file("many"), one_colour_streamed_sog(100, 300'000, 300'000));
  write_files(folder.file("few"), one_colour_streamed_sog(1, 1000, 1000));
  for (const std::string command : {"convert", "bake"}) {
    const auto spent = [&](const std::string& name) {
      return run_measured(program("voyager " + command + " " + folder.file(name) +
                                  "/lod-meta.json -o " +
                                  folder.file(command == "bake" ? "out.voy" : "out.ply")));
    };
    const Spent many = spent("many");
    expect_cheap_refusal(many, spent("few"));
    EXPECT_NE(many.output.find("Gaussians of the files: found 30000000"), std::string::npos)
        << many.output;
  }
}

TEST(SogHostileFiles, NamesReachTheTerminalWithoutControlCharacters) {
  const TempFolder folder;
  SogFiles files = sog_files(4, 0);
  nlohmann::json meta = sog_meta(4, 0);
  meta["scales"]["files"] = {"\x1b[2J.webp"};
  files["meta.json"] = bytes_of(meta.dump());
  const Bytes packed = zip(files);
  const nlohmann::json lod = {
      {"filenames", {"\x1b[2J.json"}},
      {"tree", {{"lods", {{"0", {{"file", 0}, {"offset", 0}, {"count", 1}}}}}}}};
  files["lod-meta.json"] = bytes_of(lod.dump());
  write_files(folder.file(""), files);
  write_bytes(folder.file("packed.sog"),
              {reinterpret_cast<const char*>(packed.data()), packed.size()});
  for (const std::string name : {"meta.json", "lod-meta.json", "packed.sog"}) {
    const Outcome done =
        run("voyager convert " + folder.file(name) + " -o " + folder.file("out.ply"));
    EXPECT_NE(done.exit_code, 0) << name;
    EXPECT_NE(done.output.find("\\x1b[2J"), std::string::npos) << name << ": " << done.output;
    EXPECT_EQ(done.output.find('\x1b'), std::string::npos) << name << ": " << done.output;
  }
}

}  // namespace
}  // namespace sog_hostile_files_test
}  // namespace voyager::test
