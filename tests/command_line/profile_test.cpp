// scripts/profile.sh as its usage says to call it: what it asks of `voyager bench` is taken. A stub
// stands for Nsight Compute, which needs a GPU.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/command_line/program.h"
#include "tests/support/test_support.h"

namespace voyager::profile_test {
namespace {

namespace fs = std::filesystem;

// What bench says to the call, which the stub makes with the CPU's backend.
test::Outcome profile(const std::string& options) {
  const test::TempFolder folder;
  test::write_bytes(folder.file("ncu"),
                    "#!/bin/sh\n"
                    "while [ \"$2\" != bench ]; do shift; done\n"
                    "exec env LD_LIBRARY_PATH=" VOYAGER_BIN_DIR
                    "/../lib $(echo \"$@\" | sed 's/--backend cuda/--backend cpu/') >&2\n");
  fs::permissions(folder.file("ncu"), fs::perms::owner_all);
  return test::run_shell("PATH=" + folder.file("") +
                         ":$PATH VOYAGER=" VOYAGER_BIN_DIR "/voyager " VOYAGER_SOURCE_DIR
                         "/scripts/profile.sh missing.voy missing.json " +
                         options);
}

TEST(Profile, AsksForWhatBenchTakes) {
  for (const char* options :
       {"", "--tau 3 --sms 16", "--stages splat --exp lut", "--stages=splat --exp=lut"}) {
    const test::Outcome found = profile(options);
    EXPECT_EQ(found.exit_code, 2) << found.output;
    EXPECT_EQ(found.output, "voyager: missing.voy: open: No such file or directory\n");
  }
}

}  // namespace
}  // namespace voyager::profile_test
