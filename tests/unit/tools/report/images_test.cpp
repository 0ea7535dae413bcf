// What a report says of images, and those that it compares with.
#include <gtest/gtest.h>

#include "tests/support/metric_images.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_files.h"
#include "tools/report/compare_images.h"
#include "tools/report/reference_images.h"
#include "tools/report/report_csv.h"
#include "tools/report/report_text.h"

namespace voyager::tools {
namespace images_test {
namespace {

using test::grey_image;

std::optional<double> popping_of(const std::vector<ComparedFrame>& frames,
                                 const std::vector<RgbaImage>& images) {
  std::vector<RgbaImage> still;
  for (const RgbaImage& image : images) still.push_back(grey_image(image.size() / 4, 0.25f));
  Workers workers;
  return compare_images(images, still, frames, workers).popping;
}

// Of frames that follow one another in one size; where there are none, nothing was compared, which
// is not a popping of 0.
TEST(ReportImages, PoppingIsOfFramesThatFollowOneAnotherInOneSize) {
  const RgbaImage small = grey_image(12 * 6, 0.25f), jumped = grey_image(12 * 6, 0.5f),
                  large = grey_image(24 * 8, 0.25f);
  EXPECT_EQ(popping_of({{0, 12}, {1, 12}}, {small, jumped}), 255 * 0.25);
  EXPECT_EQ(popping_of({{0, 12}, {1, 12}, {5, 12}, {6, 12}}, {small, jumped, small, small}),
            255 * 0.125);
  EXPECT_EQ(popping_of({{0, 12}, {1, 24}, {2, 24}}, {small, large, large}), 0);
  EXPECT_EQ(popping_of({{0, 12}}, {small}), std::nullopt);
  EXPECT_EQ(popping_of({{0, 12}, {2, 12}}, {small, jumped}), std::nullopt);
  EXPECT_EQ(popping_of({{0, 12}, {1, 24}}, {small, large}), std::nullopt);
  EXPECT_EQ(popping_of({{0, 12}, {1, 6}}, {small, jumped}), std::nullopt);  // 12 x 6 and 6 x 12
}

TEST(ReportImages, PoppingThatIsNotKnownIsEmpty) {
  ReportRow row;
  row.stages.resize(kStageCount);
  const auto kept = row_from_json(to_json(row), row.is);
  EXPECT_EQ(kept.same.popping, std::nullopt);
  row.same.popping = 0.0;
  EXPECT_EQ(row_from_json(to_json(row), row.is).same.popping, 0.0);
  row.truth.popping = 1.5;
  const std::string known = report_csv({}, {row}), unknown = report_csv({}, {kept});
  EXPECT_NE(known.find(",0,,0,0,0,1.5,"), std::string::npos) << known;
  EXPECT_NE(unknown.find(",0,,,0,0,0,,"), std::string::npos) << unknown;
}

TEST(ReportImages, TheMethodSaysTheSizesAndTheSensor) {
  ReportPlan plan;
  plan.path.resize(3);
  plan.compared = {0};
  const auto resize = [&](size_t i, uint32_t width, uint32_t height) {
    plan.path[i].eyes[0].camera.width = width;
    plan.path[i].eyes[0].camera.height = height;
  };
  for (size_t i = 0; i < 3; ++i) resize(i, 96, 54);
  EXPECT_EQ(method_text(plan, "").find("3 frames of 96 x 54 along"), 0u) << method_text(plan, "");
  resize(0, 128, 72);
  resize(2, 64, 36);
  EXPECT_NE(method_text(plan, "a rail").find(" Energy by a rail, over 1.5 s"), std::string::npos);
  EXPECT_EQ(method_text(plan, "").find("3 frames of 3 sizes from 64 x 36 to 128 x 72 along"), 0u)
      << method_text(plan, "");
}

TEST(ReportImages, ReferencesAreTheSameFromDisk) {
  const test::TempFolder folder;
  Workers workers;
  const test::Bytes bytes =
      test::scene_bytes(test::bake(test::random_cloud(300, 5)), Quality::lossless);
  const auto scene = load_scene(test::source_of(bytes), std::pmr::get_default_resource(), workers);
  const std::vector<FrameInput> path(3,
                                     test::frame_input(test::look({0, 0, -30}, {0, 0, 0}, 24, 24)));
  const auto references = [&] {
    return ReferenceImages(scene, path, {0, 2}, folder.file(""), workers);
  };
  ReferenceImages drawn = references();
  const std::vector<RgbaImage> cut = drawn.of({Lod::cut, {8, 2}});
  ASSERT_EQ(cut.size(), 2u);
  EXPECT_NE(cut[0], cut[1]);  // each at its own τ
  EXPECT_NE(drawn.of({}), cut);
  EXPECT_EQ(drawn.of({Lod::cut, {2, 8}}), (std::vector<RgbaImage>{cut[1], cut[0]}));
  EXPECT_EQ(drawn.of({Lod::cut, {8, 2}}), cut);
  EXPECT_EQ(references().of({Lod::cut, {8, 2}}), cut);
}

}  // namespace
}  // namespace images_test
}  // namespace voyager::tools
