// A row that is quiet hides no subtree whose verdicts may have changed.
#include "runtime/select/watch_row.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "runtime/select/references.h"

namespace voyager {
namespace watch_row_test {
namespace {

// A subtree's verdicts hold while the way from where they were found, and extent times what 1/τ*
// has changed by, are less than the slack.
struct Verdicts {
  CutQuery found;
  double slack, extent;

  bool hold(const CutQuery& now) const {
    const double x = double{now.centre.x} - found.centre.x,
                 y = double{now.centre.y} - found.centre.y,
                 z = double{now.centre.z} - found.centre.z;
    const double turn =
        std::fabs(inverse_target_size(now.target_size) - inverse_target_size(found.target_size));
    return std::sqrt(x * x + y * y + z * z) + extent * turn < slack;
  }
};

class Rows {
 public:
  explicit Rows(uint32_t seed) : random_(seed) {}

  // As search_check does it, and a visit of what is due.
  void run(const CutQuery& query) {
    references_.begin_frame(query);
    const Journey& now = references_.journey();
    ++frames;
    if (is_quiet(row_, now)) return;
    ++looks;
    const bool ends = static_cast<int32_t>(row_.moves - now.moves) <= 0;
    float least = INFINITY;
    uint32_t moves = 1u << 30;
    bool any = false;
    for (uint32_t i = 0; i < kRowSubtrees; ++i) {
      const Look look = look_at(watch_[i], references_.travel().data(), references_.retired(),
                                references_.current(), ends);
      least = std::min(least, std::max(look.slack, 0.0f));
      moves = std::min(moves, look.moves);
      if (look.due) visit(i, query), any = true;
    }
    row_ = {any ? 0.0 : now.way + double{least}, now.turns, now.moves + moves};
  }

  void expect_certain(const CutQuery& query) const {
    for (uint32_t i = 0; i < kRowSubtrees; ++i)
      if (watch_[i].slack != INFINITY) {
        ASSERT_TRUE(verdicts_[i].hold(query)) << "subtree " << i << ", frame " << frames;
      }
  }

  int frames = 0, looks = 0, visits = 0;

 private:
  void visit(uint32_t i, const CutQuery& query) {
    ++visits;
    if (random_() % 8 == 0) {  // it has nothing to decide
      watch_[i] = {INFINITY, 0};
      if (random_() % 2 == 0) return;
    }
    std::uniform_real_distribution<float> any(0.01f, 6);
    const Watch watch = make_watch(any(random_), any(random_), references_.current());
    watch_[i] = watch;
    verdicts_[i] = {query, watch.slack, watch_extent(watch)};
  }

  std::mt19937 random_;
  References references_;
  Watch watch_[kRowSubtrees]{};  // slack 0: due
  Verdicts verdicts_[kRowSubtrees]{};
  WatchRow row_{0, 0, 0};
};

// turning: one frame in so many changes τ*; 0: none does.
void walk(uint32_t seed, float step, uint32_t turning, Rows& rows) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  CutQuery query{{3, -2, 5}, 0.01f};
  for (int i = 0; i < 1500; ++i) {
    if (random() % 5 != 0)
      query.centre =
          query.centre + step * Vec3f{1 + normal(random), normal(random), normal(random)};
    if (turning != 0 && random() % turning == 0) query.target_size = 0.01f + 1e-3f * normal(random);
    rows.run(query);
    rows.expect_certain(query);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST(WatchRow, IsQuietOnlyWhereNoVerdictMayHaveChanged) {
  for (const float step : {1e-5f, 1e-3f, 0.02f, 0.3f, 3.0f})
    for (const uint32_t turning : {0u, 400u, 20u, 1u}) {
      Rows rows(7);
      walk(11, step, turning, rows);
      EXPECT_GT(rows.visits, 0);
    }
}

TEST(WatchRow, IsQuietInMostFramesOfASlowWalk) {
  Rows rows(7);
  walk(12, 1e-3f, 0, rows);
  EXPECT_LT(rows.looks, rows.frames / 4);
}

TEST(WatchRow, StandingStillNeedsNoLook) {
  Rows rows(7);
  const CutQuery query{{1, 2, 3}, 0.02f};
  for (int i = 0; i < 10; ++i) rows.run(query);
  const int before = rows.looks;
  for (int i = 0; i < 1000; ++i) rows.run(query);
  EXPECT_EQ(rows.looks, before);
}

TEST(WatchRow, WhatCannotBeSaidIsLookedAt) {
  EXPECT_FALSE(is_quiet({NAN, 0, 1}, {1, 0, 0}));
  EXPECT_FALSE(is_quiet({2, 0, 1}, {NAN, 0, 0}));
  EXPECT_TRUE(is_quiet({2, 0, 1}, {1, 0, 0}));
  EXPECT_FALSE(is_quiet({2, 0, 1}, {1, 1, 0})) << "its reference goes";
  EXPECT_FALSE(is_quiet({2, 0, 1}, {1, 0, 1})) << "τ* has changed";
  EXPECT_TRUE(is_quiet({2, 0, 5}, {1, 0xfffffff0u, 0})) << "counts go round";
}

}  // namespace
}  // namespace watch_row_test
}  // namespace voyager
