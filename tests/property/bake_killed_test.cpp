// A bake in parts that ends before its time: killed, out of memory, its disk full. Every bake is
// in a process of its own, which dies; this one has no threads that a fork would lose. The calls
// that change a disk are replaced in this program, so that a process can end, or its disk be full,
// at each of them.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>
#include <thread>

#include "runtime/bake/bake.h"
#include "runtime/scene/import/importer.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_clouds.h"

namespace {

// What the children of this program do, and are to meet.
struct Disk {
  std::atomic<int64_t> calls, bytes;
  int64_t signal_at;  // before this call, counted from 0
  int signal;
  int64_t room;  // bytes

  void reset() {
    calls = bytes = 0;
    signal_at = room = std::numeric_limits<int64_t>::max();
  }
};
Disk* disk = nullptr;  // shared by parent and children, while set

void count_call() {
  if (disk != nullptr && disk->calls++ == disk->signal_at) ::raise(disk->signal);
}

}  // namespace

extern "C" ssize_t pwrite(int fd, const void* from, size_t count, off_t at) {
  count_call();
  if (disk != nullptr) {
    const int64_t before = disk->bytes.fetch_add(static_cast<int64_t>(count));
    const int64_t left = std::max<int64_t>(disk->room - before, 0);
    count = std::min(count, static_cast<size_t>(left));
    if (left == 0) errno = ENOSPC;
    if (left == 0) return -1;
  }
  return static_cast<ssize_t>(::syscall(SYS_pwrite64, fd, from, count, at));
}

extern "C" int linkat(int from, const char* path, int to, const char* name, int flags) noexcept {
  count_call();
  return static_cast<int>(::syscall(SYS_linkat, from, path, to, name, flags));
}

extern "C" int rename(const char* from, const char* to) noexcept {
  count_call();
  return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

extern "C" int unlink(const char* path) noexcept {
  count_call();
  return static_cast<int>(::syscall(SYS_unlinkat, AT_FDCWD, path, 0));
}

extern "C" int rmdir(const char* path) noexcept {
  count_call();
  return static_cast<int>(::syscall(SYS_unlinkat, AT_FDCWD, path, AT_REMOVEDIR));
}

namespace voyager::bake_killed_test {
namespace {

constexpr int kRefused = 50;  // and the code of the error

pid_t start(const std::function<void()>& action) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  int code = 0;
  try {
    action();
  } catch (const Error& error) {
    code = kRefused + static_cast<int>(error.code());
  } catch (...) {
    code = 1;
  }
  ::_exit(code);
}

// 128 and the signal's number where one ended it.
int wait_for(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

class BakeKilled : public ::testing::Test {
 protected:
  explicit BakeKilled(size_t gaussians = 20000) : gaussians_(gaussians) {}
  void SetUp() override {
    const test::Bytes ply = test::ply_bytes(test::specks(gaussians_, 31, 1));
    std::ofstream(input, std::ios::binary)
        .write(reinterpret_cast<const char*>(ply.data()), static_cast<std::streamsize>(ply.size()));
    const int code = wait_for(start([&] {
      Workers workers;
      const auto source = open_file_source(input);
      const BakedScene baked =
          build_tree(import_gaussians(*read_source(*source)), workers, {}, test::kSmallBlocks);
      write_scene_file(baked, partition_tree(baked.tree, kDefaultChunkBytes),
                       folder.file("whole.voy"), Quality::compact, workers);
    }));
    ASSERT_EQ(code, 0);
    whole = test::file_bytes(folder.file("whole.voy"));
  }

  void bake(BakeStep step = BakeStep::all, uint32_t part = 0, uint32_t parts = 1) const {
    BakeInParts bake;
    bake.step = step;
    bake.part = part;
    bake.parts = parts;
    bake.rule = test::kSmallBlocks;
    bake.request = bake_request({input}, bake.quality, kDefaultChunkBytes, bake.rule);
    bake.output = scene;
    bake.work = work;
    bake.memory = 100'000'000;
    bake.most_in_cell = 1300;
    Workers workers;
    const OpenInputs open = [&] {
      std::vector<std::unique_ptr<BlockReader>> readers;
      readers.push_back(open_blocks(open_file_source(input)));
      return readers;
    };
    bake_in_parts(bake, open, workers, {});
  }

  void expect_whole() const {
    EXPECT_TRUE(test::file_bytes(scene) == whole);
    // What a kill left that was not marked yet, or any more, is somebody's own.
    EXPECT_TRUE(!std::filesystem::exists(work) || std::filesystem::is_empty(work));
  }

  const size_t gaussians_;
  const test::TempFolder folder;
  const std::string input = folder.file("input.ply"), scene = folder.file("parts.voy"),
                    work = folder.file("work");
  test::Bytes whole;
};

TEST_F(BakeKilled, GoesOnAfterAKillAtAnyMoment) {
  int kills = 0;
  for (int round = 0; round < 3; ++round) {
    std::filesystem::remove(scene);
    int code = 128 + SIGKILL;
    for (int wait = 10 + 23 * round; code == 128 + SIGKILL; wait += 60) {
      const pid_t child = start([&] { bake(); });
      std::this_thread::sleep_for(std::chrono::milliseconds(wait));
      ::kill(child, SIGKILL);
      code = wait_for(child);
      kills += code == 128 + SIGKILL;
      if (std::filesystem::exists(scene)) {
        ASSERT_TRUE(test::file_bytes(scene) == whole);
      }
    }
    ASSERT_EQ(code, 0);
    expect_whole();
  }
  EXPECT_GT(kills, 3);
}

TEST_F(BakeKilled, GoesOnAfterAFullDisk) {
  const uint64_t room[] = {100'000, 1'000'000};  // of a file: for the spool, for what follows
  for (const uint64_t most : room) {
    const int code = wait_for(start([&] {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{most, most};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      bake();
    }));
    EXPECT_EQ(code, kRefused + static_cast<int>(ErrorCode::io)) << most;
    EXPECT_FALSE(std::filesystem::exists(scene));
  }
  ASSERT_EQ(wait_for(start([&] { bake(); })), 0);
  expect_whole();
}

TEST_F(BakeKilled, GoesOnAfterMemoryWasRefused) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need more address space than the test allows";
#endif
  int refused = 0;
  for (const uint64_t megabytes : {1, 4, 16, 64}) {
    const int code = wait_for(start([&] {
      Workers().for_blocks(64, 1, [](size_t, size_t) {});  // threads are there
      std::ifstream statm("/proc/self/statm");
      uint64_t pages = 0;
      statm >> pages;
      const uint64_t most = pages * static_cast<uint64_t>(::getpagesize()) + megabytes * 1'000'000;
      const rlimit limit{most, most};
      ::setrlimit(RLIMIT_AS, &limit);
      bake();
    }));
    EXPECT_LT(code, 128 + SIGHUP) << "a signal, not an error";
    refused += code != 0;
    if (code == 0) break;
  }
  EXPECT_GT(refused, 0);
  ASSERT_EQ(wait_for(start([&] { bake(); })), 0);
  expect_whole();
}

constexpr BakeStep kSteps[] = {BakeStep::split, BakeStep::cells, BakeStep::encode, BakeStep::merge};

// Fewer Gaussians, in as few cells as steps take.
class BakeStopped : public BakeKilled {
 protected:
  BakeStopped() : BakeKilled(6000) {
    void* const shared =
        ::mmap(nullptr, sizeof(Disk), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    calls_ = new (shared) Disk;
  }
  ~BakeStopped() override { ::munmap(calls_, sizeof(Disk)); }

  // In a child, with what calls_ says.
  int run(const std::function<void()>& action) const {
    return wait_for(start([&] {
      disk = calls_;
      action();
    }));
  }
  int64_t below(int64_t most) {
    return std::uniform_int_distribution<int64_t>(0, most - 1)(random_);
  }

  // The same command until it ends, each time but the last ended before one of its calls.
  void end_at_calls(int signal, int64_t calls, int times, const std::function<void()>& action) {
    for (int code = -1, time = 0; code != 0; ++time) {
      calls_->reset();
      calls_->signal = signal;
      if (time < times) calls_->signal_at = below(calls);
      code = run(action);
      ASSERT_TRUE(code == 0 || (code == 128 + signal && time < times))
          << code << ", signal " << signal << " at call " << calls_->signal_at;
      if (std::filesystem::exists(scene)) {
        ASSERT_TRUE(test::file_bytes(scene) == whole);
      }
    }
  }

  Disk* calls_ = nullptr;
  std::mt19937_64 random_{22};
};

TEST_F(BakeStopped, EveryStepGoesOnAfterASignalBeforeAnyCall) {
  int64_t calls[std::size(kSteps)];
  for (size_t i = 0; i < std::size(kSteps); ++i) {
    calls_->reset();
    ASSERT_EQ(run([&] { bake(kSteps[i]); }), 0);
    calls[i] = calls_->calls;
    ASSERT_GT(calls[i], 4);
  }
  // Where the mark is gone, and the folder not yet, merge has nothing to go on from.
  --calls[3];
  for (const int signal : {SIGKILL, SIGTERM, SIGINT}) {
    std::filesystem::remove(scene);
    for (size_t i = 0; i < std::size(kSteps); ++i)
      ASSERT_NO_FATAL_FAILURE(end_at_calls(signal, calls[i], 3, [&] { bake(kSteps[i]); }))
          << "step " << i;
    expect_whole();
  }
}

// Processes that share the folder, some of them killed: a step of all of it makes up for these.
TEST_F(BakeStopped, PartsOfAStepAreDoneSideBySide) {
  calls_->reset();
  ASSERT_EQ(run([&] { bake(BakeStep::split); }), 0);
  for (const BakeStep step : {BakeStep::cells, BakeStep::encode}) {
    std::vector<pid_t> children;
    for (uint32_t part = 0; part < 4; ++part)
      children.push_back(start([&] { bake(step, part, 4); }));
    ::kill(children.back(), SIGKILL);
    const int last = wait_for(children.back());
    EXPECT_TRUE(last == 0 || last == 128 + SIGKILL) << last;
    children.pop_back();
    for (const pid_t child : children) EXPECT_EQ(wait_for(child), 0);
    EXPECT_FALSE(std::filesystem::exists(scene));
    if (step == BakeStep::cells) {
      ASSERT_EQ(run([&] { bake(step); }), 0);
    }
  }
  ASSERT_EQ(run([&] { bake(BakeStep::merge); }), 0);
  expect_whole();
}

TEST_F(BakeStopped, AWholeBakeGoesOnAfterASignalBeforeAnyCall) {
  calls_->reset();
  ASSERT_EQ(run([&] { bake(); }), 0);
  const int64_t calls = calls_->calls;
  for (const int signal : {SIGKILL, SIGTERM, SIGINT})
    for (int round = 0; round < 3; ++round) {
      std::filesystem::remove(scene);
      ASSERT_NO_FATAL_FAILURE(end_at_calls(signal, calls, 3, [&] { bake(); }));
      expect_whole();
    }
}

// The last calls remove the folder, when the scene is there: it is not baked again.
TEST_F(BakeStopped, ABakeThatWasKilledWhenTheSceneWasThereHasNothingToDo) {
  calls_->reset();
  ASSERT_EQ(run([&] { bake(); }), 0);
  const int64_t calls = calls_->calls;
  for (int64_t before_end = 3; before_end < 6; ++before_end) {
    std::filesystem::remove(scene);
    calls_->reset();
    calls_->signal = SIGKILL;
    calls_->signal_at = calls - before_end;
    ASSERT_EQ(run([&] { bake(); }), 128 + SIGKILL);
    const auto changed = std::filesystem::last_write_time(scene);
    calls_->reset();
    ASSERT_EQ(run([&] { bake(); }), 0);
    EXPECT_LT(calls_->calls, before_end + 8);
    EXPECT_EQ(std::filesystem::last_write_time(scene), changed);
    expect_whole();
  }
}

TEST_F(BakeStopped, AFullDiskAtAnyByteLeavesNothingThatLooksWhole) {
  calls_->reset();
  ASSERT_EQ(run([&] { bake(); }), 0);
  const int64_t bytes = calls_->bytes;
  bool begun = false;
  for (int round = 0; round < 8; ++round) {
    std::filesystem::remove(scene);
    calls_->reset();
    calls_->room = below(bytes);
    const int ended = run([&] { bake(); });
    if (begun && ended == 0) {  // the room was enough for what an earlier round had left to do
      expect_whole();
      begun = false;
      continue;
    }
    EXPECT_EQ(ended, kRefused + static_cast<int>(ErrorCode::io)) << calls_->room;
    EXPECT_FALSE(std::filesystem::exists(scene)) << calls_->room;
    begun = true;
    if (round % 2 == 0) continue;
    calls_->reset();
    ASSERT_EQ(run([&] { bake(); }), 0);
    expect_whole();
    begun = false;
  }
}

TEST_F(BakeStopped, AFullDiskLeavesNoSceneThatWasBakedInMemory) {
  const auto write = [&] {
    Workers workers;
    const auto source = open_file_source(input);
    const BakedScene baked =
        build_tree(import_gaussians(*read_source(*source)), workers, {}, test::kSmallBlocks);
    write_scene_file(baked, partition_tree(baked.tree, kDefaultChunkBytes), scene, Quality::compact,
                     workers);
  };
  const auto files = [&] {
    return std::distance(std::filesystem::directory_iterator(folder.file("")), {});
  };
  const auto before = files();
  for (int round = 0; round < 4; ++round) {
    calls_->reset();
    calls_->room = below(static_cast<int64_t>(whole.size()));
    EXPECT_EQ(run(write), kRefused + static_cast<int>(ErrorCode::io)) << calls_->room;
    EXPECT_EQ(files(), before);
  }
}

}  // namespace
}  // namespace voyager::bake_killed_test
