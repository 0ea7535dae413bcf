// scripts/profile.sh as its usage says to call it. A stub stands for Nsight Compute, which needs a
// GPU.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "runtime/frame/backend.h"
#include "tests/command_line/program.h"
#include "tests/support/test_support.h"

namespace voyager::profile_test {
namespace {

namespace fs = std::filesystem;

// With a shell script in the place of ncu.
test::Outcome profile(const std::string& ncu, const std::string& options) {
  const test::TempFolder folder;
  test::write_bytes(folder.file("ncu"), "#!/bin/sh\n" + ncu);
  fs::permissions(folder.file("ncu"), fs::perms::owner_all);
  return test::run_shell("PATH=" + folder.file("") +
                         ":$PATH VOYAGER=" VOYAGER_BIN_DIR "/voyager " VOYAGER_SOURCE_DIR
                         "/scripts/profile.sh missing.voy missing.json " +
                         options);
}

// What bench says to the call, which the stub makes with the CPU's backend.
TEST(Profile, AsksForWhatBenchTakes) {
  const std::string bench =
      "while [ \"$2\" != bench ]; do shift; done\n"
      "exec env LD_LIBRARY_PATH=" VOYAGER_BIN_DIR
      "/../lib $(echo \"$@\" | sed 's/--backend cuda/--backend cpu/') >&2\n";
  for (const char* options : {"", "--tau 3 --sms 16 --repeat 2", "--stages splat --exp lut",
                              "--stages=splat --exp=lut"}) {
    const test::Outcome found = profile(bench, options);
    EXPECT_EQ(found.exit_code, 2) << found.output;
    EXPECT_EQ(found.output, "voyager: missing.voy: open: No such file or directory\n");
  }
}

TEST(Profile, SaysWhatNcuSays) {
  const test::Outcome found =
      profile("echo '==ERROR== ERR_NVGPUCTRPERM: no permission'\necho '\"ID\"'\nexit 1\n", "");
  EXPECT_EQ(found.exit_code, 1);
  EXPECT_EQ(found.output, "==ERROR== ERR_NVGPUCTRPERM: no permission\n");
}

// Two launches of one kernel and one without a counter of its bytes: 4 and 6 us, 3 and 5 MB at
// 1,000 bytes a cycle of 1 GHz, 10 and 30 per cent idle.
TEST(Profile, PrintsARowForEachKernel) {
  const std::string columns =
      "\"Kernel Name\",\"gpu__time_duration.sum\",\"dram__bytes.sum\","
      "\"dram__bytes.sum.peak_sustained\",\"dram__cycles_elapsed.avg.per_second\","
      "\"lts__t_bytes.sum\",\"smsp__inst_executed.sum\","
      "\"sm__warps_active.avg.pct_of_peak_sustained_active\",\"sm__cycles_active.avg\","
      "\"sm__cycles_elapsed.max\"\n";
  const std::string rows =
      "\"\",\"ns\",\"byte\",\"byte/cycle\",\"cycle/"
      "second\",\"byte\",\"inst\",\"%\",\"cycle\",\"cycle\"\n"
      "\"void voyager::cuda::(anonymous "
      "namespace)::rasterize_tiles<X>(P)\",\"4,000\",\"3,000,000\","
      "\"1,000\",\"1,000,000,000\",\"8,000,000\",\"2,000,000\",\"50\",\"900\",\"1,000\"\n"
      "\"void voyager::cuda::(anonymous "
      "namespace)::rasterize_tiles<X>(P)\",\"6,000\",\"5,000,000\","
      "\"1,000\",\"1,000,000,000\",\"8,000,000\",\"2,000,000\",\"70\",\"700\",\"1,000\"\n"
      "\"voyager::cuda::sort_large(V)\",\"1,000\",\"n/a\",\"n/a\",\"n/a\",\"n/a\",\"n/a\",\"n/"
      "a\",\"n/a\",\"n/a\"\n";
  const test::Outcome found =
      profile("cat <<'END'\n==PROF== connected\n" + columns + rows + "END\n", "");
  EXPECT_EQ(found.exit_code, 0) << found.output;
  const auto has_row = [&](std::initializer_list<const char*> cells) {
    std::string row;
    for (const char* cell : cells) row += std::string(" *") + cell;
    return std::regex_search(found.output, std::regex("(^|\\n)" + row.substr(2) + "\\n"));
  };
  EXPECT_TRUE(has_row({"rasterize_tiles", "2", "5.0", "4.00", "4.0", "8.00", "2.00", "60", "20"}))
      << found.output;
  EXPECT_TRUE(has_row({"sort_large", "1", "1.0", "-", "-", "-", "-", "-", "-"})) << found.output;
}

// A stage of another name would be missing from the table, and nobody would see it.
TEST(Profile, AsksForEveryStageThatHasKernels) {
  const std::string script = test::file_bytes(VOYAGER_SOURCE_DIR "/scripts/profile.sh");
  for (int stage = 0; stage < kResolve; ++stage)
    EXPECT_NE(script.find(std::string("'voyager@") + kStageNames[stage] + "/'"), std::string::npos)
        << kStageNames[stage];
}

}  // namespace
}  // namespace voyager::profile_test
