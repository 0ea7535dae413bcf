#include "runtime/scene/export/flat_file.h"

#include <algorithm>

#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::flat_file_test {
namespace {

TEST(FlatFile, TheEndOfTheNameSaysTheFormat) {
  EXPECT_EQ(flat_format_of("a/b.ply"), FlatFormat::ply);
  EXPECT_EQ(flat_format_of("a/b.compressed.ply"), FlatFormat::compressed_ply);
  EXPECT_EQ(flat_format_of("b.spz"), FlatFormat::spz);
  EXPECT_EQ(flat_format_of("b.splat"), FlatFormat::splat);
  EXPECT_EQ(flat_format_of("b.glb"), FlatFormat::glb);
  EXPECT_EQ(flat_format_of("b.sog"), FlatFormat::sog);
  EXPECT_EQ(flat_format_of("B.PLY"), FlatFormat::ply);
  EXPECT_EQ(flat_format_of("B.Compressed.Ply"), FlatFormat::compressed_ply);
  for (const char* name : {"", "ply", "b.voy", "b.ply.png"})
    EXPECT_EQ(flat_format_of(name), std::nullopt) << name;
}

TEST(FlatFile, SaysWhatTheFormatHasNoPlaceFor) {
  FlatContents contents;
  contents.sh_degree = 1;
  contents.native = compensated_scale(kMipSplattingLowPass);
  contents.origin = {4404.0 * 1024, 0, 0};
  contents.largest_coordinate = 4.5e6;
  const auto lost = [&](FlatFormat format) { return losses(format, contents).size(); };
  EXPECT_EQ(lost(FlatFormat::ply), 0u);
  EXPECT_EQ(lost(FlatFormat::compressed_ply), 1u) << "positions";
  EXPECT_EQ(lost(FlatFormat::spz), 2u) << "positions, the filter";
  EXPECT_EQ(lost(FlatFormat::splat), 3u) << "positions, the filter, SH";
  EXPECT_EQ(lost(FlatFormat::glb), 1u) << "the filter";
  EXPECT_EQ(lost(FlatFormat::sog), 2u) << "positions, the filter";
  contents = {};
  for (const FlatFormat format : {FlatFormat::ply, FlatFormat::compressed_ply, FlatFormat::spz,
                                  FlatFormat::splat, FlatFormat::glb, FlatFormat::sog})
    EXPECT_EQ(lost(format), 0u);
}

// Each format's last value is inside, and the next one outside.
TEST(FlatFile, SaysHowManyGaussiansHaveClampedValues) {
  GaussianCloud cloud = test::random_cloud(4, 1, 1);
  cloud.native = {};
  std::fill(cloud.log_scale.begin(), cloud.log_scale.end(), -10.0f);
  std::fill(cloud.sh.begin(), cloud.sh.end(), 1.0f);
  cloud.log_scale[0] = 5.9375f;
  const auto clamped = [&](FlatFormat format, const FlatOptions& options = {}) -> std::string {
    FlatContents contents;
    contents.add(cloud);
    const std::vector<std::string> lost = losses(format, contents, options);
    return lost.empty() ? "" : lost.front().substr(0, lost.front().find(':'));
  };
  const std::string two = "values outside of the format's range are clamped, in 2 of 4 Gaussians";
  for (const FlatFormat format : {FlatFormat::spz, FlatFormat::splat, FlatFormat::compressed_ply})
    EXPECT_EQ(clamped(format), "");
  cloud.log_scale[1] = 8.0f;
  cloud.log_scale[3] = -10.01f;
  EXPECT_EQ(clamped(FlatFormat::spz), two);
  EXPECT_EQ(clamped(FlatFormat::glb, {.spz_inside = true}), two);
  for (const FlatFormat format : {FlatFormat::ply, FlatFormat::compressed_ply, FlatFormat::splat,
                                  FlatFormat::glb, FlatFormat::sog})
    EXPECT_EQ(clamped(format), "");
  cloud.sh[0] = 1.78f;
  cloud.sh[13] = -1.78f;
  EXPECT_EQ(clamped(FlatFormat::splat), two);
  cloud.sh[11] = 4.01f;
  cloud.sh[23] = -4.01f;
  EXPECT_EQ(clamped(FlatFormat::compressed_ply), two);
}

TEST(FlatFile, SaysThatNoFormatHasANativePixel) {
  FlatContents contents;
  contents.native = {NativeSource::estimated, 0.05};
  for (const FlatFormat format : {FlatFormat::ply, FlatFormat::compressed_ply, FlatFormat::spz,
                                  FlatFormat::splat, FlatFormat::glb, FlatFormat::sog}) {
    const std::vector<std::string> lost = losses(format, contents);
    ASSERT_EQ(lost.size(), 1u);
    EXPECT_NE(lost[0].find("native pixel, 0.05 m"), std::string::npos) << lost[0];
  }
}

// ln(101) / 65535 of 101 metres is 7 mm, ln(201) / 65535 of 201 metres 16 mm.
TEST(FlatFile, SaysWhereStepsOfASogAreLarge) {
  FlatContents contents;
  contents.most = {100, 0, 0};
  EXPECT_EQ(losses(FlatFormat::sog, contents).size(), 0u);
  contents.most = {200, 0, 0};
  const std::vector<std::string> lost = losses(FlatFormat::sog, contents);
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_NE(lost[0].find("steps of up to 0.0163 m"), std::string::npos) << lost[0];
}

// Inputs that are joined may lie far apart: 5 km from the origin of the first, which is 4500 km
// from the world's.
TEST(FlatFile, SaysFromWhichOriginAPositionIsFar) {
  FlatContents contents;
  contents.origin = contents.least = {4404.0 * 1024, 0, 0};
  contents.most = {4404.0 * 1024 + 5000, 0, 0};
  contents.largest_coordinate = contents.most[0];
  const std::vector<std::string> inside =
      losses(FlatFormat::glb, contents, {.spz_version = 3, .spz_inside = true});
  ASSERT_EQ(inside.size(), 1u);
  EXPECT_NE(inside[0].find("5e+03 m from the scene's origin, (4509696, 0, 0) m"), std::string::npos)
      << inside[0];
  const std::vector<std::string> alone = losses(FlatFormat::spz, contents);
  ASSERT_EQ(alone.size(), 1u);
  EXPECT_NE(alone[0].find("4.51e+06 m from the world's origin"), std::string::npos) << alone[0];
}

TEST(FlatFile, ContentsHaveTheBoundsOfAllBatches) {
  FlatContents contents;
  GaussianCloud cloud = test::random_cloud(2, 4, 0);
  cloud.origin = {1024, 0, 0};
  for (const float x : {3.0f, -5.0f}) {
    cloud.position = {x, 7.0f, -1.0f, x + 1, 8.0f, -2.0f};
    contents.add(cloud);
  }
  EXPECT_EQ(contents.least, (std::array<double, 3>{1019, 7, -2}));
  EXPECT_EQ(contents.most, (std::array<double, 3>{1028, 8, -1}));
  EXPECT_EQ(contents.largest_coordinate, 1028);
}

bool is_left_out(const std::string& ending) {
  if (ending != ".sog") return false;
  try {
    require_sog();
  } catch (const Error&) {
    return true;
  }
  return false;
}

TEST(FlatFile, EveryFormatIsWrittenUnderItsName) {
  const test::TempFolder folder;
  const GaussianCloud cloud = test::random_cloud(300, 4, 1);
  FlatContents contents;
  contents.sh_degree = 1;
  contents.add(cloud);
  for (const std::string& ending : flat_format_endings()) {
    if (is_left_out(ending)) continue;
    write_flat_file(folder.file("out" + ending), {}, contents,
                    [&](GaussianWriter& writer) { writer.append(cloud); });
    EXPECT_GE(std::filesystem::file_size(folder.file("out" + ending)), 300 * 22u) << ending;
  }
}

TEST(FlatFile, AnUnfinishedFileIsNotThere) {
  const test::TempFolder folder;
  FlatContents contents;
  contents.count = 3;
  for (const std::string& ending : flat_format_endings()) {
    EXPECT_THROW(write_flat_file(folder.file("out" + ending), {}, contents, [](GaussianWriter&) {}),
                 Error);
    EXPECT_FALSE(std::filesystem::exists(folder.file("out" + ending))) << ending;
  }
}

}  // namespace
}  // namespace voyager::flat_file_test
