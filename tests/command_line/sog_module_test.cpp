// SOG scenes are read and written by a module, which alone needs libwebp and libzip.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/abi/elf.h"
#include "tests/command_line/program.h"
#include "tests/support/test_support.h"

namespace voyager::sog_module_test {
namespace {

using namespace voyager::test;
namespace fs = std::filesystem;

const std::string kLibraries = VOYAGER_BIN_DIR "/../lib/";

bool needs(const std::string& path, const std::string& library) {
  const std::vector<std::string> needed = ElfFile(path).needed();
  return std::any_of(needed.begin(), needed.end(),
                     [&](const std::string& name) { return name.starts_with(library + "."); });
}

TEST(SogModule, IsAllThatNeedsLibwebpAndLibzip) {
  for (const char* library : {"libwebp.so", "libzip.so"}) {
    EXPECT_TRUE(needs(kLibraries + "libvoyager_sog.so", library));
    EXPECT_FALSE(needs(kLibraries + "libvoyager.so", library));
    EXPECT_FALSE(needs(VOYAGER_BIN_DIR "/voyager", library));
  }
  EXPECT_EQ(ElfFile(kLibraries + "libvoyager_sog.so").exports(),
            std::vector<std::string>{"voyager_sog_module"});
}

TEST(SogModule, WhereItIsMissingIsNamed) {
  const TempFolder folder;
  fs::create_directories(folder.file("bin"));
  fs::create_directories(folder.file("lib"));
  fs::copy_file(VOYAGER_BIN_DIR "/voyager", folder.file("bin/voyager"));
  for (const auto& entry : fs::directory_iterator(kLibraries)) {
    const std::string name = entry.path().filename();
    if (name.starts_with("libvoyager.so"))
      fs::copy(entry.path(), folder.file("lib/" + name), fs::copy_options::copy_symlinks);
  }
  const std::string scene = folder.file("scene.sog");
  write_bytes(scene, "PK\3\4");
  const Outcome done = run_shell("LD_LIBRARY_PATH=" + folder.file("lib") + " " +
                                 folder.file("bin/voyager") + " info " + scene);
  EXPECT_EQ(done.exit_code, 1) << done.output;
  EXPECT_NE(done.output.find(scene + ": a SOG scene: libvoyager_sog.so: not found in "),
            std::string::npos)
      << done.output;
}

}  // namespace
}  // namespace voyager::sog_module_test
