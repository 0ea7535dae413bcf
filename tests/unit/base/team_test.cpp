#include "runtime/base/team.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace voyager::team_test {
namespace {

// Each index has its turn once, whoever comes by; a lane is one thread's at a time.
TEST(Team, RunsEachIndexOnce) {
  Team team(3);
  std::atomic<bool> ended{false};
  std::vector<std::thread> others;
  for (int i = 0; i < 4; ++i)  // more than have a lane
    others.emplace_back([&] {
      while (!ended)
        if (!team.help()) std::this_thread::yield();
    });
  for (int round = 0; round < 200; ++round) {
    const Team::Session session(team);
    for (const size_t n : {0, 1, 5, 1000}) {
      std::vector<std::atomic<int>> turns(n), in_lane(team.lanes());
      team.loop(n, [&](unsigned lane, size_t i) {
        EXPECT_EQ(in_lane.at(lane)++, 0);
        ++turns[i];
        --in_lane[lane];
      });
      for (const auto& of : turns) ASSERT_EQ(of, 1);
    }
  }
  ended = true;
  for (std::thread& other : others) other.join();
}

TEST(Team, ThrowsWhatABodyThrew) {
  Team team(2);
  const Team::Session session(team);
  EXPECT_THROW(team.loop(100,
                         [](unsigned, size_t i) {
                           if (i == 50) throw std::runtime_error("one of them");
                         }),
               std::runtime_error);
  size_t runs = 0;
  team.loop(10, [&](unsigned, size_t) { ++runs; });
  EXPECT_EQ(runs, 10u);
}

TEST(Team, NobodyHelpsWhereNoSessionIsOpen) {
  Team team(2), alone(1);
  EXPECT_FALSE(team.help());
  const Team::Session session(alone);
  EXPECT_FALSE(alone.help());
}

}  // namespace
}  // namespace voyager::team_test
