// What a report says of frames whose times and counters are known.
#include "tools/frame_report.h"

#include <gtest/gtest.h>

#include "tools/frame_floor.h"

namespace voyager::tools {
namespace frame_report_test {
namespace {

using Json = nlohmann::ordered_json;

constexpr DeviceRates kRates{1e12, 1e11};

// Two cameras of 100 x 50 pixels, thrice.
FramePath two_cameras() {
  FramePath path;
  path.frames.resize(2);
  for (FrameInput& frame : path.frames) {
    frame.eyes[0].camera.width = 100;
    frame.eyes[0].camera.height = 50;
  }
  path.repeats = 3;
  return path;
}

// Stages of 1, 2, 4, 8, 16 milliseconds times `factor`, and 100 to hand the image out.
FrameStats frame_of(double factor) {
  FrameStats stats;
  const double stages[] = {1, 2, 4, 8, 16, 100};
  for (int stage = 0; stage < kStageCount; ++stage)
    stats.milliseconds[stage] = factor * stages[stage];
  stats.cut_size = 1000;
  stats.splats = 500;
  stats.pairs_before = 4000;
  stats.pairs_after = 2000;
  stats.pixels_evaluated = 400'000'000;
  stats.pixels_blended = 100'000'000;
  stats.places_read = 800;
  stats.bytes[kProject] = 138'000;
  stats.bytes[kRasterize] = 1'000'000;
  return stats;
}

// The second camera takes ten times as long.
FrameRun run_of_two() {
  FrameRun run;
  for (const double factor : {1.0, 10.0, 2.0, 20.0, 3.0, 30.0})
    run.timed.push_back(frame_of(factor));
  run.counted = {frame_of(1), frame_of(1)};
  return run;
}

Json report(const FrameRun& run, const DeviceRates& rates = kRates) {
  const FramePath path = two_cameras();
  return report_row(ablation_rows(Search::temporal).back(), run, {path, rates, 3, false});
}

TEST(FrameReport, TheFrameIsAllButHandingOut) {
  const Json row = report(run_of_two());
  EXPECT_EQ(row["ms"]["frame"]["median"], 3 * 31);
  EXPECT_EQ(row["ms"]["frame"]["p99"], 30 * 31);
  EXPECT_EQ(row["ms"]["splat"]["median"], 3 * 30);
  EXPECT_EQ(row["ms"]["search"]["mean"], 11);
  EXPECT_EQ(row["ms"]["resolve"]["median"], 300);
}

TEST(FrameReport, CamerasHaveMediansOfTheirOwn) {
  const Json row = report(run_of_two());
  ASSERT_EQ(row["cameras"].size(), 2u);
  EXPECT_EQ(row["cameras"][0]["ms"]["frame"], 2 * 31);
  EXPECT_EQ(row["cameras"][1]["ms"]["rasterize"], 20 * 16);
  EXPECT_EQ(row["cameras"][1]["index"], 1);
}

TEST(FrameReport, ScoresAreFloorOverTime) {
  const Json row = report(run_of_two());
  const Json& floor = row["floor"];
  EXPECT_EQ(floor["attribute_bytes"], 236);
  // Milliseconds at 1e11 bytes and 1e12 slots a second.
  const double project = 138'000 / 1e8, sort = (500 * 68 + 2000 * 26) / 1e8,
               blend = 100e6 * 11 / 1e9, out = 100 * 50 * 4 / 1e8;
  EXPECT_DOUBLE_EQ(floor["ms"]["project"], project);
  EXPECT_DOUBLE_EQ(floor["score"]["project"], project / (3 * 2));
  EXPECT_DOUBLE_EQ(floor["score"]["sort"], sort / (3 * (4 + 8)));
  EXPECT_DOUBLE_EQ(floor["score"]["rasterize"], blend / (3 * 16));
  EXPECT_DOUBLE_EQ(floor["score"]["frame"], (project + sort + blend + out) / (3 * 31));
  EXPECT_EQ(row["work_efficiency"], 0.25);
  EXPECT_DOUBLE_EQ(row["orin"]["stage_ms"]["project"], 138'000 / 204.8e6);
  EXPECT_DOUBLE_EQ(row["orin"]["stage_ms"]["rasterize"], 100e6 * 11 / 2.66e9);
}

// A pass that counts draws other lists than a timed one, which leaves out what is hidden.
TEST(FrameReport, PlacesReadAreThoseOfThePassThatCountsThem) {
  FrameRun run = run_of_two();
  for (FrameStats& stats : run.timed) stats.pairs_after = 500, stats.places_read = 0;
  const Json counters = report(run)["counters"];
  EXPECT_EQ(counters["pairs_after"], 500);
  EXPECT_EQ(counters["list_places"], 2000);
  EXPECT_EQ(counters["list_places_read"], 800);
}

TEST(FrameReport, WhatIsNotKnownIsNull) {
  FrameRun run = run_of_two();
  run.counted.clear();
  const Json row = report(run);
  EXPECT_TRUE(row["counters"]["pixels_blended"].is_null());
  EXPECT_TRUE(row["counters"]["list_places_read"].is_null());
  EXPECT_TRUE(row["work_efficiency"].is_null());
  EXPECT_TRUE(row["floor"]["ms"]["blend"].is_null());
  EXPECT_TRUE(row["floor"]["score"]["frame"].is_null());
  EXPECT_FALSE(row["floor"]["score"]["sort"].is_null());
  EXPECT_TRUE(report(run, {})["floor"].is_null());
  EXPECT_TRUE(row["orin"]["stage_ms"]["sort"].is_null());
  for (FrameStats& stats : run.timed) std::fill_n(stats.bytes, int{kStageCount}, 0);
  EXPECT_TRUE(report(run)["orin"]["stage_ms"].is_null());  // a host
}

TEST(FrameReport, SpeedupsAreOverBaseAnd3dgs) {
  Json rows = Json::array();
  for (const auto& [name, ms] : {std::pair{"3dgs", 12.0}, {"ours", 2.0}})
    rows.push_back({{"name", name}, {"ms", {{"frame", {{"median", ms}}}}}});
  add_speedups(rows);
  EXPECT_EQ(rows[1]["speedup"]["3dgs"], 6);
  EXPECT_EQ(rows[0]["speedup"]["3dgs"], 1);
  EXPECT_TRUE(rows[1]["speedup"]["base"].is_null());  // no such row
}

// From one row to the next, one thing changes; only "ours" also changes how α is found.
TEST(FrameReport, AblationGoesFrom3dgsToOursInSteps) {
  const std::vector<FrameRow> rows = ablation_rows(Search::sweep);
  ASSERT_EQ(rows.size(), 7u);
  EXPECT_EQ(rows[0].desc.lod, Lod::all_leaves);
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(rows[i].desc.splatting, Splatting::baseline_3dgs);
  for (size_t i = 4; i < 7; ++i) EXPECT_EQ(rows[i].desc.splatting, Splatting::ours);
  const Search searches[] = {Search::exhaustive,     Search::streaming,      Search::temporal_visit,
                             Search::temporal_visit, Search::temporal_visit, Search::sweep};
  for (size_t i = 1; i < 7; ++i) {
    EXPECT_EQ(rows[i].desc.lod, Lod::cut) << rows[i].name;
    EXPECT_EQ(rows[i].desc.search, searches[i - 1]) << rows[i].name;
  }
  EXPECT_EQ(rows[4].desc.exponential, Exponential::exact);
  EXPECT_EQ(rows[5].desc.exponential, Exponential::lut);
  EXPECT_EQ(rows[5].desc.lut_size, 32u);
  EXPECT_EQ(rows[6].desc.exponential, Exponential::ex2);
}

}  // namespace
}  // namespace frame_report_test
}  // namespace voyager::tools
