// A folder that the program makes, marks, works in and removes: nobody else's files go with it.
#include "runtime/base/owned_folder.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <set>

#include "runtime/base/error.h"
#include "tests/support/test_support.h"

namespace voyager::owned_folder_test {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

constexpr FolderKind kTest = {
    "a test", "give another",
    [](std::string_view name, std::string_view) { return name == "rows" || name == "words"; }};
constexpr FolderKind kOther = {"another test", "give another",
                               [](std::string_view, std::string_view) { return true; }};

void write(const std::string& path, const std::string& text = "x") {
  std::ofstream(path) << text;
}

class OwnedFolderTest : public testing::Test {
 protected:
  OwnedFolder take(const std::string& key = "one\n", bool alone = true) const {
    return {path, kTest, key, alone};
  }
  Names names() const {
    Names names;
    for (const auto& entry : fs::directory_iterator(path))
      names.insert(entry.path().filename().string());
    return names;
  }
  // The refusal says all of `says`, and touches nothing.
  void expect_refused(ErrorCode code, const std::vector<std::string>& says,
                      const std::string& key = "one\n") const {
    const Names before = names();
    try {
      take(key);
      ADD_FAILURE() << says.front();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      for (const std::string& part : says)
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
    EXPECT_EQ(names(), before);
  }

  const test::TempFolder temporary;
  const std::string path = temporary.file("a/b/folder");
};

TEST_F(OwnedFolderTest, IsMarkedFirstAndRemovedWithItsFiles) {
  OwnedFolder folder = take();
  EXPECT_TRUE(folder.made());
  EXPECT_EQ(names(), Names{kFolderMark});
  write(path + "/rows");
  write(path + "/words.partial-12-3");  // of a file that was being written
  EXPECT_TRUE(folder.remove().empty());
  EXPECT_FALSE(fs::exists(path));
  EXPECT_TRUE(fs::exists(temporary.file("a/b")));
}

TEST_F(OwnedFolderTest, WhatSomebodyElsePutThereStays) {
  OwnedFolder folder = take();
  write(path + "/rows");
  for (const char* name : {"thesis.tex", "rows.partial-x", "rows.partial-1-"})
    write(path + "/" + name);
  fs::create_directories(path + "/words/of mine");
  const std::vector<std::string> left = folder.remove();
  const Names expected = {"thesis.tex", "rows.partial-x", "rows.partial-1-", "words"};
  EXPECT_EQ(Names(left.begin(), left.end()), expected);
  EXPECT_EQ(names(), expected);
  expect_refused(ErrorCode::refused_input, {path, "expected an empty folder or one of a test"});
}

TEST_F(OwnedFolderTest, AFolderOfSomebodyElsesIsNotTouched) {
  fs::create_directories(path);
  write(path + "/rows", "not a test's");
  expect_refused(ErrorCode::refused_input, {"found rows", "an empty folder", "give another"});
  fs::remove(path + "/rows");
  write(path + "/" + kFolderMark, "my own");
  expect_refused(ErrorCode::refused_input, {kFolderMark, "that of a test"});
  fs::remove(path + "/" + kFolderMark);
  EXPECT_TRUE(take().made());
}

TEST_F(OwnedFolderTest, GoesOnUnderTheSameKeyAlone) {
  { take(); }
  EXPECT_FALSE(take().made());
  expect_refused(ErrorCode::refused_input, {"a test of \"one\"", "expected \"two\""}, "two\n");
  { OwnedFolder(path, kTest, "two\n", true, OwnedFolder::OtherKey::emptied); }
  expect_refused(ErrorCode::refused_input, {"a test of \"two\"", "expected \"one\""});
}

TEST_F(OwnedFolderTest, AnEmptiedFolderKeepsWhatIsNotItsOwn) {
  { take(); }
  write(path + "/rows");
  write(path + "/thesis.tex");
  EXPECT_THROW(OwnedFolder(path, kTest, "two\n", true, OwnedFolder::OtherKey::emptied), Error);
  EXPECT_EQ(names(), Names{"thesis.tex"});
}

TEST_F(OwnedFolderTest, OneIsAloneOrSeveralAreNot) {
  {
    const OwnedFolder first = take("one\n", false), second = take("one\n", false);
    expect_refused(ErrorCode::io, {path, "another process at work"});
  }
  const OwnedFolder alone = take();
  expect_refused(ErrorCode::io, {path, "another process at work"});
  EXPECT_THROW(take("one\n", false), Error);
}

TEST_F(OwnedFolderTest, OnlyWhatIsAbandonedAndOfTheKindIsRemovedUnasked) {
  const auto remove = [&] {
    OwnedFolder::remove_abandoned(path, kTest);
    return !fs::exists(path);
  };
  EXPECT_TRUE(remove());  // there is none
  {
    const OwnedFolder living = take();
    EXPECT_FALSE(remove());
  }
  OwnedFolder::remove_abandoned(path, kOther);
  EXPECT_TRUE(fs::exists(path));
  EXPECT_TRUE(remove());
  fs::create_directories(path);
  write(path + "/rows");
  EXPECT_FALSE(remove());
}

// Many processes want the folder, and remove it when they had it: never two at a time, and none
// takes a folder that another is about to remove.
TEST_F(OwnedFolderTest, ManyProcessesHaveItOneAfterTheOther) {
  constexpr int kProcesses = 4, kRounds = 200;
  const auto worker = [&] {
    for (int round = 0; round < kRounds;) try {
        OwnedFolder folder = take();
        const int fd = ::open((path + "/rows").c_str(), O_CREAT | O_EXCL | O_WRONLY, 0666);
        if (fd < 0) return 1;  // another is in
        ::close(fd);
        if (!folder.made() || !folder.remove().empty()) return 2;
        ++round;
      } catch (const Error& error) {
        if (error.code() != ErrorCode::io) return 3;
      }
    return 0;
  };
  std::vector<pid_t> children;
  for (int i = 0; i < kProcesses; ++i) {
    children.push_back(::fork());
    if (children.back() == 0) ::_exit(worker());
  }
  for (const pid_t child : children) {
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0) << WEXITSTATUS(status);
  }
  EXPECT_FALSE(fs::exists(path));
}

}  // namespace
}  // namespace voyager::owned_folder_test
