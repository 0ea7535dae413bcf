// What a report recommends.
#include <gtest/gtest.h>

#include "tools/report/pareto.h"
#include "tools/report/report_text.h"

namespace voyager::tools {
namespace advice_test {
namespace {

ReportRow row(double tau, double ms, double flip) {
  ReportRow found;
  found.is.group = tau == 3 ? "default" : "tau";
  found.is.sh_degree = 3;
  found.is.storage = Storage::compact;
  found.is.tau = found.tau = tau;
  found.frame = {ms, 1.1 * ms, 1.2 * ms};
  found.truth.flip = flip;
  return found;
}

void expect_advice(const std::vector<ReportRow>& rows, double target, size_t row, bool in_time) {
  const Advice advice = advise(rows, target);
  EXPECT_EQ(advice.row, row) << target;
  EXPECT_EQ(advice.in_time, in_time) << target;
}

TEST(ReportAdvice, IsTheBestOfWhatIsInTime) {
  const std::vector<ReportRow> rows = {row(3, 30, 0.01), row(6, 9, 0.03), row(15, 4, 0.08)};
  expect_advice(rows, 11.1, 1, true);
  expect_advice(rows, 1000, 0, true);
  expect_advice(rows, 9.5, 2, true);  // by its p95 the second is late
  expect_advice(rows, 1, 2, false);
}

// No option of render or bake drops SH bands.
TEST(ReportAdvice, CanBeFollowed) {
  std::vector<ReportRow> rows = {row(3, 9, 0.03), row(3, 8, 0.02), row(15, 1, 0.1)};
  rows[1].is.sh_degree = rows[2].is.sh_degree = 0;
  rows[2].is.group = "combination";
  expect_advice(rows, 11.1, 0, true);
  expect_advice(rows, 0.5, 0, false);
}

TEST(ReportAdvice, IsNotLeftToNoise) {
  std::vector<ReportRow> rows = {row(3, 9, 0.03), row(3, 8, 0.03), row(3, 7, 0.03)};
  rows[1].is.group = "filter";
  rows[2].is.group = "search";
  expect_advice(rows, 11.1, 0, true);
  expect_advice(rows, 1, 0, false);
  // An image of nothing is the same however it is drawn.
  expect_advice({row(3, 2, 0), row(15, 1, 0)}, 11.1, 0, true);
  expect_advice({row(3, 20, 0), row(15, 2, 0), row(6, 1, 0)}, 11.1, 2, true);
}

// The same options, SH degree and storage, whether or not it is in time.
TEST(ReportAdvice, NamesTheWholeConfiguration) {
  const std::vector<ReportRow> rows = {row(3, 9, 0.03)};
  const std::string whole =
      "--tau 3 --exp exact (SH degree 3, compact). It takes 9.000 ms, 9.900 at p95, for a FLIP of "
      "0.0300 against the truth.";
  EXPECT_EQ(advice_text(rows, {0, true}, 11.111), "For 11.11 ms a frame: " + whole);
  EXPECT_EQ(advice_text(rows, {0, false}, 5),
            "Nothing that was measured stays within 5 ms at p95. The fastest: " + whole);
}

}  // namespace
}  // namespace advice_test
}  // namespace voyager::tools
