// A folder that fills in one step.
#include "tools/output_folder.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <fstream>
#include <set>

#include "tests/support/test_support.h"

namespace voyager::tools {
namespace {

std::set<std::string> names_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

// Of a process that has ended.
pid_t dead_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return child;
}

TEST(OutputFolder, IsWholeOrNotThere) {
  const test::TempFolder folder;
  const std::string path = folder.file("out");
  {
    OutputFolder output(path);
    std::ofstream(output.place("a")) << "a";
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  {
    OutputFolder output(path);
    std::ofstream(output.place("a")) << "a";
    EXPECT_FALSE(names_in(path).contains("a"));
    output.commit();
  }
  EXPECT_EQ(names_in(path), std::set<std::string>{"a"});
}

TEST(OutputFolder, WhatTheKilledLeftIsRemovedAndNothingElse) {
  const test::TempFolder folder;
  const std::string alive = ".partial-" + std::to_string(::getppid());
  const std::set<std::string> others = {alive, ".partial-", ".partial-1x", ".report", "a"};
  for (const std::string& name : others) std::filesystem::create_directory(folder.file(name));
  for (const pid_t process : {dead_process(), ::getpid()}) {
    const std::string left = folder.file(".partial-" + std::to_string(process));
    std::filesystem::create_directory(left);
    std::ofstream(left + "/image.png") << "half of it";
  }
  { OutputFolder output(folder.file("")); }
  EXPECT_EQ(names_in(folder.file("")), others);
}

}  // namespace
}  // namespace voyager::tools
