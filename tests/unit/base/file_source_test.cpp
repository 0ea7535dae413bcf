// What a local file gives, read through the page cache or past it, and how its failures are told
// apart. pread is replaced in this program, so that a disk can be made to fail.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <functional>
#include <random>
#include <thread>

#include "runtime/base/error.h"
#include "runtime/base/file.h"
#include "tests/support/test_support.h"

namespace {

// What pread does instead, while set: negative is -errno.
std::function<ssize_t(int fd, void* into, size_t count, off_t at)> disk;

ssize_t real_pread(int fd, void* into, size_t count, off_t at) {
  return static_cast<ssize_t>(::syscall(SYS_pread64, fd, into, count, at));
}

}  // namespace

extern "C" ssize_t pread(int fd, void* into, size_t count, off_t at) {
  if (!disk) return real_pread(fd, into, count, at);
  const ssize_t got = disk(fd, into, count, at);
  if (got >= 0) return got;
  errno = static_cast<int>(-got);
  return -1;
}

namespace voyager::file_source_test {
namespace {

using Bytes = std::string;

Bytes random_bytes(size_t count) {
  std::mt19937 random(5);
  Bytes bytes(count, '\0');
  for (char& b : bytes) b = static_cast<char>(random());
  return bytes;
}

void write_file(const std::string& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

// Not in tmpfs, where there is nothing to read past.
class FileSource : public testing::TestWithParam<Access> {
 protected:
  ~FileSource() override {
    disk = nullptr;
    ::unlink(path_.c_str());
  }
  void open(const Bytes& bytes) {
    bytes_ = bytes;
    write_file(path_, bytes);
    source_ = open_file_source(path_);
    source_->expect(GetParam());
  }
  Bytes read(uint64_t offset, size_t count) const {
    Bytes into(count, '\0');
    source_->read(offset, std::as_writable_bytes(std::span(into)));
    return into;
  }
  bool same(uint64_t offset, size_t count) const {
    return std::memcmp(read(offset, count).data(), bytes_.data() + offset, count) == 0;
  }
  // Its error, with a code that is not one where there is none.
  Error error_of(uint64_t offset, size_t count) const {
    try {
      read(offset, count);
    } catch (const Error& error) {
      return error;
    }
    return Error(ErrorCode::invalid_argument, "no error");
  }

  const std::string path_ = "file_source_test." + std::to_string(::getpid()) + ".bin";
  Bytes bytes_;
  std::unique_ptr<ByteSource> source_;
};

TEST_P(FileSource, GivesAnyRange) {
  open(random_bytes(1'100'017));  // larger than a bounce buffer, no multiple of a block
  const uint64_t edges[] = {0,    1,       511,     512,     4095,      4096,
                            4097, 1048575, 1048576, 1048577, 1'100'000, 1'100'017};
  for (const uint64_t first : edges)
    for (const uint64_t end : edges)
      EXPECT_TRUE(end < first || same(first, end - first)) << first << " to " << end;
}

TEST_P(FileSource, GivesRangesToManyThreadsAtOnce) {
  open(random_bytes(2'000'003));
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (uint32_t t = 0; t < 6; ++t)
    threads.emplace_back([&, t] {
      std::mt19937 random(t);
      for (int i = 0; i < 50; ++i) {
        const uint64_t offset = random() % bytes_.size();
        wrong += !same(offset, random() % std::min<size_t>(100'000, bytes_.size() - offset));
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

TEST_P(FileSource, RefusesRangesBeyondTheEnd) {
  open(random_bytes(1000));
  for (const uint64_t offset : {uint64_t{1000}, uint64_t{999}, ~uint64_t{0}}) {
    const Error error = error_of(offset, 2);
    EXPECT_EQ(error.code(), ErrorCode::refused_input) << error.what();
  }
  EXPECT_TRUE(same(1000, 0));
}

TEST_P(FileSource, TruncatedWhileOpenIsToldWithTheOffset) {
  open(random_bytes(20'000));
  ASSERT_EQ(::truncate(path_.c_str(), 9'000), 0);
  EXPECT_TRUE(same(100, 8'900));
  for (const auto& [offset, count] : {std::pair<uint64_t, size_t>{8'000, 2'000}, {12'345, 10}}) {
    const Error error = error_of(offset, count);
    EXPECT_EQ(error.code(), ErrorCode::io);
    const std::string what = error.what();
    EXPECT_NE(what.find("offset " + std::to_string(std::max<uint64_t>(offset, 9'000))),
              std::string::npos)
        << what;
    EXPECT_NE(what.find("end of the file at 9000, expected it at 20000"), std::string::npos)
        << what;
  }
}

TEST_P(FileSource, WhatMayPassIsToldFromWhatWillNot) {
  open(random_bytes(5000));
  const std::pair<int, ErrorCode> cases[] = {{EIO, ErrorCode::io_transient},
                                             {EAGAIN, ErrorCode::io_transient},
                                             {ETIMEDOUT, ErrorCode::io_transient},
                                             {ESTALE, ErrorCode::io},
                                             {EISDIR, ErrorCode::io}};
  for (const auto& [number, code] : cases) {
    disk = [&](int, void*, size_t, off_t) { return -number; };
    const Error error = error_of(10, 20);
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_NE(std::string(error.what()).find("offset 10"), std::string::npos) << error.what();
  }
  disk = nullptr;
  EXPECT_TRUE(same(10, 20)) << "the source goes on after an error";
}

TEST_P(FileSource, ShortAndInterruptedReadsAreGoneOnWith) {
  open(random_bytes(100'000));
  int calls = 0;
  disk = [&](int fd, void* into, size_t count, off_t at) -> ssize_t {
    if (++calls % 3 == 0) return -EINTR;
    return real_pread(fd, into, std::min<size_t>(count, 8192), at);
  };
  EXPECT_TRUE(same(3, 99'990));
  EXPECT_GT(calls, 12);
}

std::string access_name(const testing::TestParamInfo<Access>& access) {
  const char* const names[] = {"forward", "scattered", "uncached"};
  return names[static_cast<size_t>(access.param)];
}

INSTANTIATE_TEST_SUITE_P(, FileSource,
                         testing::Values(Access::forward, Access::scattered, Access::uncached),
                         access_name);

bool is_direct(int fd) {
  return (::fcntl(fd, F_GETFL) & O_DIRECT) != 0;
}

class DirectFile : public FileSource {};
INSTANTIATE_TEST_SUITE_P(, DirectFile, testing::Values(Access::uncached), access_name);

TEST_P(DirectFile, ReadsPastThePageCacheInWholeBlocks) {
  open(random_bytes(50'000));
  int odd = 0, cached = 0, calls = 0;
  disk = [&](int fd, void* into, size_t count, off_t at) {
    odd += reinterpret_cast<uintptr_t>(into) % 4096 != 0 || count % 4096 != 0 || at % 4096 != 0;
    cached += !is_direct(fd);
    ++calls;
    return real_pread(fd, into, count, at);
  };
  EXPECT_TRUE(same(4097, 30'001));
  if (cached == calls) GTEST_SKIP() << "this folder's file system has no direct reads";
  EXPECT_EQ(cached, 0);
  EXPECT_EQ(odd, 0);
}

TEST_P(DirectFile, FallsBackWhereTheFileSystemRefusesOnlyAtTheRead) {
  open(random_bytes(50'000));
  disk = [&](int fd, void* into, size_t count, off_t at) -> ssize_t {
    return is_direct(fd) ? -EINVAL : real_pread(fd, into, count, at);
  };
  EXPECT_TRUE(same(77, 40'000));
  EXPECT_TRUE(same(78, 40'000));
}

TEST_P(DirectFile, CanBeTakenBack) {
  open(random_bytes(50'000));
  source_->expect(Access::forward);
  disk = [&](int fd, void* into, size_t count, off_t at) -> ssize_t {
    return is_direct(fd) ? -EINVAL : real_pread(fd, into, count, at);
  };
  EXPECT_TRUE(same(77, 40'000));
}

TEST(FileSourceOnTmpfs, IsReadWithoutTheCacheAsWithIt) {
  const std::string path = "/dev/shm/voyager_file_source_test." + std::to_string(::getpid());
  const Bytes bytes = random_bytes(10'001);
  write_file(path, bytes);
  if (::access(path.c_str(), R_OK) != 0) GTEST_SKIP() << "no /dev/shm here";
  const auto source = open_file_source(path);
  source->expect(Access::uncached);
  Bytes into(9'000, '\0');
  source->read(1'001, std::as_writable_bytes(std::span(into)));
  EXPECT_EQ(into, bytes.substr(1'001));
  ::unlink(path.c_str());
}

// In pieces of 64 kB, each in a hole.
TEST(FileSourceHoles, AFileThatIsMostlyHolesIsRefusedByName) {
  const std::string path = "file_source_test." + std::to_string(::getpid()) + ".holes";
  const Bytes piece = random_bytes(65'536);
  const struct {
    off_t size;
    int pieces;
    bool refused;
  } cases[] = {{60'000'000, 1, false},
               {68'000'000, 0, true},
               {68'000'000, 250, true},
               {68'000'000, 270, false}};
  for (const auto& [size, pieces, refused] : cases) {
    const int fd = ::open(path.c_str(), O_CREAT | O_TRUNC | O_RDWR, 0600);
    ASSERT_EQ(::ftruncate(fd, size), 0);
    for (int i = 0; i < pieces; ++i)
      ASSERT_EQ(::pwrite(fd, piece.data(), piece.size(), off_t{196'608} * i), 65'536);
    const bool knows_holes = ::lseek(fd, 0, SEEK_HOLE) < size;
    ::close(fd);
    try {
      open_file_source(path);
      EXPECT_FALSE(refused && knows_holes) << pieces;
    } catch (const Error& error) {
      EXPECT_TRUE(refused) << pieces;
      EXPECT_EQ(error.code(), ErrorCode::refused_input);
      const std::string says = error.what();
      EXPECT_TRUE(says.starts_with(path + ": found ")) << says;
      EXPECT_NE(says.find(" of data in a file of 68.000 MB"), std::string::npos) << says;
    }
  }
  ::unlink(path.c_str());
}

// Neither is it opened: that could wait for whoever writes to a FIFO.
TEST(FileSourceKinds, WhatIsNoRegularFileIsRefusedByName) {
  const std::string path = "file_source_test." + std::to_string(::getpid()) + ".fifo";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  for (const auto& [of, name] :
       {std::pair(path, "a FIFO"), std::pair(std::string("."), "a directory"),
        std::pair(std::string("/dev/null"), "character device")})
    try {
      open_file_source(of);
      ADD_FAILURE() << of;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::refused_input);
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  ::unlink(path.c_str());
}

}  // namespace
}  // namespace voyager::file_source_test
