#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/bake/bake.h"
#include "runtime/bake/work_files.h"
#include "runtime/bake/work_folder.h"
#include "tests/command_line/program.h"
#include "tests/support/test_support.h"
#include "tools/view/background_bake.h"
#include "tools/view/bake_cache.h"
#include "tools/view/sample.h"

namespace voyager::view_bake_test {
namespace {

using namespace voyager::view;
namespace fs = std::filesystem;

class ViewBake : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(::setenv("XDG_CACHE_HOME", folder_.file("cache").c_str(), 1), 0);
    make_cache_folder();
  }
  std::string cached(const std::string& name) const {
    return folder_.file("cache/voyager/" + name);
  }
  // As a bake has it that runs, or was killed.
  static std::unique_ptr<WorkFolder> work_of(const std::string& bake, const std::string& request) {
    auto work = std::make_unique<WorkFolder>(work_folder(bake), request, true, true);
    test::write_bytes(work->file(kPositionRows), "rows");
    return work;
  }

  test::TempFolder folder_;
};

TEST_F(ViewBake, WhatAKilledBakeLeftGoesAndWhatRunsStays) {
  const pid_t child = ::fork();
  if (child == 0) {
    work_of(cached("killed.voy"), "a\n").release();
    ::_exit(0);
  }
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  ASSERT_TRUE(fs::exists(work_folder(cached("killed.voy"))));
  const auto running = work_of(cached("running.voy"), "b\n");
  trim_cache(cached("used.voy"));
  EXPECT_FALSE(fs::exists(work_folder(cached("killed.voy"))));
  EXPECT_TRUE(fs::exists(work_folder(cached("running.voy"))));
}

// Others may write to any folder that is not the user's own.
TEST_F(ViewBake, WithoutAFolderOfTheUsersThereIsNoCache) {
  const char* home = std::getenv("HOME");
  const std::optional<std::string> kept = home ? std::optional<std::string>(home) : std::nullopt;
  ASSERT_EQ(::unsetenv("HOME") | ::unsetenv("XDG_CACHE_HOME"), 0);
  try {
    make_cache_folder();
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("--keep names a file"), std::string::npos);
  }
  const std::vector<std::byte> bytes(1);
  EXPECT_THROW(cached_bake("a.ply", MemorySource("a.ply", bytes)), Error);
  EXPECT_EQ(kept ? ::setenv("HOME", kept->c_str(), 1) : 0, 0);
}

// Two viewers of one scene.
TEST_F(ViewBake, WaitsForAnotherBakeOfTheSame) {
  const std::string scene = folder_.file("scene.ply"), bake = cached("scene.voy");
  const std::vector<std::byte> ply = as_ply(test::random_cloud(50, 1));
  test::write_bytes(scene, {reinterpret_cast<const char*>(ply.data()), ply.size()});
  const BakeInParts defaults;
  auto other = work_of(bake, bake_request({scene}, defaults.quality, defaults.chunk_bytes));
  int waited = 0;
  bake_scene(scene, bake, [&](const std::string& stage, uint64_t, uint64_t) {
    if (!stage.starts_with("waiting")) return;
    EXPECT_FALSE(fs::exists(bake));
    if (++waited == 2) other = nullptr;  // and made none
  });
  EXPECT_EQ(waited, 2);
  EXPECT_TRUE(fs::exists(bake));
  EXPECT_FALSE(fs::exists(work_folder(bake)));

  fs::remove(bake);
  other = work_of(bake, bake_request({scene}, defaults.quality, defaults.chunk_bytes));
  bake_scene(scene, bake, [&](const std::string&, uint64_t, uint64_t) {
    test::write_bytes(bake, "the other's");
  });
  EXPECT_EQ(test::file_bytes(bake), "the other's");
}

}  // namespace
}  // namespace voyager::view_bake_test
