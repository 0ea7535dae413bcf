// A file that appears whole or not at all, where a name or a symbolic link says.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "runtime/base/error.h"
#include "runtime/base/file.h"
#include "runtime/base/output_path.h"
#include "tests/support/test_support.h"

namespace voyager::atomic_file_test {
namespace {

namespace fs = std::filesystem;

void write(const std::string& path, const std::string& text, bool commit = true) {
  AtomicFile file(path);
  file.write(std::as_bytes(std::span(text)));
  if (commit) file.commit();
}

std::string read(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

size_t count_in(const std::string& folder) {
  return static_cast<size_t>(std::distance(fs::directory_iterator(folder), {}));
}

void expect_refused(const std::string& path, const std::string& says) {
  try {
    write(path, "x");
    ADD_FAILURE() << path;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::io);
    EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
  }
}

TEST(AtomicFile, IsThereOnlyWhenItIsWhole) {
  const test::TempFolder folder;
  const std::string path = folder.file("a");
  write(path, "first", false);
  EXPECT_EQ(count_in(folder.file("")), 0u);
  write(path, "first");
  write(path, "second", false);
  EXPECT_EQ(read(path), "first");
  write(path, "second");
  EXPECT_EQ(read(path), "second");
  EXPECT_EQ(count_in(folder.file("")), 1u);
}

TEST(AtomicFile, IsWrittenThroughSymbolicLinks) {
  const test::TempFolder folder;
  fs::create_directory(folder.file("far"));
  write(folder.file("far/target"), "before");
  fs::create_symlink("far/target", folder.file("link"));
  fs::create_symlink("link", folder.file("link to it"));
  write(folder.file("link to it"), "after");
  EXPECT_EQ(read(folder.file("far/target")), "after");
  EXPECT_TRUE(fs::is_symlink(folder.file("link to it")));
  EXPECT_TRUE(fs::is_symlink(folder.file("link")));
  fs::create_symlink(folder.file("far/new"), folder.file("dangling"));
  write(folder.file("dangling"), "new");
  EXPECT_EQ(read(folder.file("far/new")), "new");
  EXPECT_EQ(count_in(folder.file("far")), 2u);
}

TEST(AtomicFile, TakesNoNameThatIsTakenWhereItMustBeNew) {
  const test::TempFolder folder;
  const std::string path = folder.file("a");
  AtomicFile first(path), second(path);
  EXPECT_TRUE(first.commit_new());
  EXPECT_FALSE(second.commit_new());
  EXPECT_EQ(count_in(folder.file("")), 1u);
}

TEST(AtomicFile, WhatCannotBeWrittenIsRefusedBeforeAByteIs) {
  const test::TempFolder folder;
  fs::create_directory(folder.file("folder"));
  expect_refused(folder.file("folder"), "found a directory");
  ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0666), 0);
  expect_refused(folder.file("pipe"), "found a FIFO");
  fs::create_symlink("/dev/full", folder.file("full"));
  expect_refused(folder.file("full"), "found a terminal or another character device");
  fs::create_symlink("circle", folder.file("circle"));
  expect_refused(folder.file("circle"), "circle");
  expect_refused(folder.file("no/such/folder"), "No such file");
  expect_refused(folder.file("folder/" + std::string(250, 'a')), "too long");
  write(folder.file("file"), "x");
  expect_refused(folder.file("file/b"), "Not a directory");
  if (::geteuid() == 0) return;  // who may write anything
  write(folder.file("mine"), "kept");
  fs::permissions(folder.file("mine"), fs::perms::owner_read);
  expect_refused(folder.file("mine"), "must not be written to");
  EXPECT_EQ(read(folder.file("mine")), "kept");
}

TEST(AtomicFile, RoomIsAskedOfTheDeviceThatALinkLeadsTo) {
  const test::TempFolder folder;
  struct statvfs info = {};
  ASSERT_EQ(::statvfs(folder.file("").c_str(), &info), 0);
  const uint64_t free = uint64_t{info.f_bavail} * info.f_frsize;
  EXPECT_NO_THROW(require_room(folder.file("a"), free / 2));
  EXPECT_THROW(require_room(folder.file("a"), 4 * free + 1'000'000'000), Error);
  EXPECT_NO_THROW(require_room(folder.file("no/such/folder"), ~uint64_t{0}));
  if (::statvfs("/dev/shm", &info) != 0 || ::access("/dev/shm", W_OK) != 0) return;
  fs::create_symlink("/dev/shm/voyager-room", folder.file("link"));
  const uint64_t there = uint64_t{info.f_bavail} * info.f_frsize;
  EXPECT_THROW(require_room(folder.file("link"), 4 * there + 1'000'000'000), Error);
}

TEST(AtomicFile, KnowsTheNamesThatItsFilesHaveOnTheWay) {
  EXPECT_EQ(without_partial("rows.partial-12-0"), "rows");
  for (const char* name : {"rows", "rows.partial-", "rows.partial-1", "rows.partial-1-",
                           "rows.partial--1", "rows.partial-a-1", "rows.partial-1-1x"})
    EXPECT_EQ(without_partial(name), name);
}

}  // namespace
}  // namespace voyager::atomic_file_test
