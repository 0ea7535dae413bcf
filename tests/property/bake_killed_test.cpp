// A bake in parts that ends before its time: killed, out of memory, its disk full. Every bake is
// in a process of its own, which dies; this one has no threads that a fork would lose.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <functional>
#include <thread>

#include "runtime/bake/bake.h"
#include "runtime/scene/import/importer.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_clouds.h"

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
  void SetUp() override {
    const test::Bytes ply = test::ply_bytes(test::specks(20000, 31, 1));
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

  void bake() const {
    BakeInParts bake;
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
    EXPECT_FALSE(std::filesystem::exists(work));
  }

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

}  // namespace
}  // namespace voyager::bake_killed_test
