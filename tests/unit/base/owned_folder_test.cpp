// A folder that the program makes, marks, works in and removes: nobody else's files go with it.
#include "runtime/base/owned_folder.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include "runtime/base/error.h"
#include "tests/support/test_support.h"

namespace voyager::owned_folder_test {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

constexpr FolderKind kTest = {"a test", "give another",
                              [](std::string_view name, const std::vector<std::string>&) {
                                return name == "rows" || name == "words";
                              }};
constexpr FolderKind kOther = {
    "another test", "give another",
    [](std::string_view, const std::vector<std::string>&) { return true; }};

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
  EXPECT_TRUE(folder.marked());
  EXPECT_EQ(names(), Names{kFolderMark});
  write(path + "/rows");
  write(path + "/words.partial-12-3");  // of a file that was being written
  EXPECT_TRUE(folder.remove().empty());
  EXPECT_FALSE(fs::exists(path));
  EXPECT_FALSE(fs::exists(temporary.file("a")));  // it was made for the folder
  EXPECT_TRUE(fs::exists(temporary.file("")));
}

TEST_F(OwnedFolderTest, FoldersThatWereThereBeforeStay) {
  fs::create_directories(temporary.file("a"));
  EXPECT_TRUE(take().remove().empty());
  EXPECT_FALSE(fs::exists(temporary.file("a/b")));
  EXPECT_TRUE(fs::exists(temporary.file("a")));
  fs::create_directories(path);
  { take(); }  // is not removed: a kill leaves it like this
  write(path + "/rows");
  EXPECT_TRUE(take().remove().empty());
  EXPECT_EQ(names(), Names{});
}

// A folder that another refuses is not made, either.
TEST_F(OwnedFolderTest, NothingIsLeftOfFoldersThatCannotBeMade) {
  fs::create_directories(temporary.file("a"));
  EXPECT_THROW(OwnedFolder(path + "/" + std::string(300, 'x'), kTest, "one\n", true), Error);
  write(temporary.file("file"));
  EXPECT_THROW(OwnedFolder(temporary.file("file/folder"), kTest, "one\n", true), Error);
  EXPECT_EQ(std::distance(fs::recursive_directory_iterator(temporary.file("")), {}), 2);
}

TEST_F(OwnedFolderTest, AFolderThatWasMovedAwayAndMadeAnewIsNotItsOwn) {
  OwnedFolder first = take();
  write(path + "/rows");
  fs::rename(path, temporary.file("away"));
  EXPECT_TRUE(first.own_files().empty());
  const OwnedFolder second = take();
  write(path + "/rows");
  EXPECT_TRUE(first.remove().empty());
  EXPECT_EQ(names(), (Names{kFolderMark, "rows"}));
  EXPECT_TRUE(fs::exists(temporary.file("away/rows")));
}

constexpr FolderKind kNoted = {"a test", "give another",
                               [](std::string_view name, const std::vector<std::string>& notes) {
                                 return std::find(notes.begin(), notes.end(), name) != notes.end();
                               }};

TEST_F(OwnedFolderTest, NotesSayWhatIsOwnAndAreNotCompared) {
  {
    OwnedFolder folder(path, kNoted, "one\n", true);
    for (const char* note : {"first", "second", "first"}) folder.add_note(note);
    for (const char* name : {"first", "second", "third"}) write(path + "/" + name);
  }
  OwnedFolder folder(path, kNoted, "one\n", true);
  const std::vector<std::string> own = folder.own_files();
  EXPECT_EQ(Names(own.begin(), own.end()), (Names{"first", "second"}));
  EXPECT_EQ(folder.remove(), std::vector<std::string>{"third"});
}

TEST_F(OwnedFolderTest, AKeyIsAnyText) {
  for (const std::string key : {"", "no line", "a line\n", "a line\n\nand another\n", "\n"}) {
    OwnedFolder(path, kNoted, key, true).add_note("first");
    write(path + "/first");
    EXPECT_TRUE(OwnedFolder(path, kNoted, key, true).remove().empty()) << key;
    EXPECT_FALSE(fs::exists(path)) << key;
  }
}

TEST_F(OwnedFolderTest, AnAlteredMarkIsRefused) {
  OwnedFolder(path, kNoted, "one\n", true).add_note("first");
  const std::string mark = path + "/" + kFolderMark;
  std::ifstream file(mark);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  for (size_t at = 0; at < text.size(); ++at) {
    std::string altered = text;
    altered[at] = static_cast<char>(altered[at] ^ 4);
    write(mark, altered);
    EXPECT_THROW(OwnedFolder(path, kNoted, "one\n", true), Error) << at;
  }
  for (size_t length = 0; length < text.size(); ++length) {
    if (length > 0 && text[length - 1] == '\n' && length > text.find("\n\n") + 1) continue;
    write(mark, text.substr(0, length));
    EXPECT_THROW(OwnedFolder(path, kNoted, "one\n", true), Error) << length;
  }
  write(mark, text);
  EXPECT_NO_THROW(OwnedFolder(path, kNoted, "one\n", true));
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
  EXPECT_TRUE(take().marked());
}

// b is only on the way to c.
TEST_F(OwnedFolderTest, FoldersOnTheWayAreNotLeft) {
  const test::TempFolder within;
  const std::string dots = within.file("a/./b/../c/");
  {
    OwnedFolder folder(dots, kTest, "one\n", true);
    write(folder.path() + "/rows");
    EXPECT_TRUE(fs::exists(within.file("a/c/rows")));
    folder.remove();
  }
  EXPECT_FALSE(fs::exists(within.file("a")));
}

TEST_F(OwnedFolderTest, WhatIsNoFileUnderTheNameOfTheMarkIsNamed) {
  fs::create_directories(path);
  const std::string mark = path + "/" + kFolderMark;
  ASSERT_EQ(::mkfifo(mark.c_str(), 0600), 0);
  expect_refused(ErrorCode::refused_input, {std::string("found a FIFO named ") + kFolderMark});
  fs::remove(mark);
  fs::create_directory(mark);
  expect_refused(ErrorCode::refused_input, {std::string("found a directory named ") + kFolderMark});
  fs::remove(mark);
  fs::create_symlink("elsewhere", mark);
  expect_refused(ErrorCode::refused_input, {"found a symbolic link named "});
}

TEST_F(OwnedFolderTest, GoesOnUnderTheSameKeyAlone) {
  { take(); }
  EXPECT_FALSE(take().marked());
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
        if (!folder.marked() || !folder.remove().empty()) return 2;
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
  // One may have made the folder when another marked it: then it stays.
  EXPECT_TRUE(!fs::exists(path) || fs::is_empty(path));
}

}  // namespace
}  // namespace voyager::owned_folder_test
