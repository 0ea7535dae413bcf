// A folder that fills in one step.
#include "tools/output_folder.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <set>

#include "tests/support/test_support.h"

namespace voyager::tools {
namespace output_folder_test {
namespace {

std::set<std::string> names_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

TEST(OutputFolder, IsWholeOrNotThere) {
  const test::TempFolder folder;
  const std::string path = folder.file("out");
  {
    OutputFolder output(path, {});
    std::ofstream(output.place("a")) << "a";
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  {
    OutputFolder output(path, {});
    std::ofstream(output.place("a")) << "a";
    EXPECT_FALSE(names_in(path).contains("a"));
    output.commit();
  }
  EXPECT_EQ(names_in(path), std::set<std::string>{"a"});
}

TEST(OutputFolder, WhatTheKilledLeftIsRemovedAndNothingElse) {
  const test::TempFolder folder;
  const std::string path = folder.file("");
  OutputFolder living(path, {});
  std::ofstream(living.place("b")) << "b";
  const pid_t child = ::fork();
  if (child == 0) {
    OutputFolder killed(path, {});
    std::ofstream(killed.place("c")) << "half of it";
    ::raise(SIGKILL);
  }
  ::waitpid(child, nullptr, 0);
  std::filesystem::create_directory(folder.file(".report"));
  EXPECT_EQ(names_in(path).size(), 3u);
  { OutputFolder next(path, {}); }
  EXPECT_EQ(names_in(path).size(), 2u);
  EXPECT_TRUE(names_in(path).contains(".report"));
  living.commit();
  EXPECT_TRUE(names_in(path).contains("b"));
}

}  // namespace
}  // namespace output_folder_test
}  // namespace voyager::tools
