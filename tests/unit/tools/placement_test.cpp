#include "tools/placement.h"

#include <gtest/gtest.h>

#include "runtime/scene/import/importer.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"
#include "tests/support/transforms.h"

namespace voyager::placement_test {
namespace {

using tools::parse_transform;

void expect_maps(const Affine& affine, const Vec3d& from, const Vec3d& to) {
  const Vec3d found = affine * from;
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(found[axis], to[axis], 1e-12) << axis;
}

TEST(Placement, TermsAreDoneOneAfterTheOther) {
  expect_maps(parse_transform("scale 2, rotate 0 0 1 90, translate 10 0 5"), {1, 0, 0}, {10, 2, 5});
  expect_maps(parse_transform("translate 1 0 0,scale -1 2 3"), {1, 1, 1}, {-2, 2, 3});
  expect_maps(parse_transform("rotate 0 -3 0 90"), {0, 0, 1}, {-1, 0, 0});
}

TEST(Placement, AMatrixIsRows) {
  const Affine expected{{{{1, 2, 3}, {5, 6, 7}, {9, 10, -11.5}}}, {4, 8, 12}};
  EXPECT_EQ(parse_transform("1 2 3 4, 5 6 7 8, 9 10 -11.5 12"), expected);
  EXPECT_EQ(parse_transform("1 2 3 4,5 6 7 8,9 10 -11.5 12,0 0 0 1"), expected);
}

TEST(Placement, RefusesWhatIsNeither) {
  for (const char* text :
       {"", ",", "scale", "scale 1 2", "scale x", "turn 1 2 3 4", "rotate 1 2 3", "rotate 0 0 0 90",
        "translate 1 2", "1 2 3 4", "1 2 3 4, 5 6 7 8", "1 2 3, 4 5 6, 7 8 9",
        "1 0 0 0, 0 1 0 0, 0 0 1 0, 0 0 0 2", "1 0 0 nan, 0 1 0 0, 0 0 1 0", "1 0 0 0, 0 1 0 0, a"})
    EXPECT_THROW(parse_transform(text), CLI::ValidationError) << text;
}

TEST(Placement, UpEndsAtMinusY) {
  for (const auto& [axis, up] :
       {std::pair("y", Vec3d{0, 1, 0}), {"z", Vec3d{0, 0, 1}}, {"-y", Vec3d{0, -1, 0}}}) {
    expect_maps(tools::turn_up(axis), up, {0, -1, 0});
    EXPECT_NEAR(determinant(tools::turn_up(axis).linear), 1, 1e-15);
  }
}

TEST(Placement, OneIsForAllAndElseThereIsOneForEach) {
  tools::Placement placement;
  EXPECT_FALSE(placement.given());
  placement.up = {"z"};
  placement.transforms = {parse_transform("translate 1 0 0"), parse_transform("translate 2 0 0")};
  const std::vector<Affine> places = placement.of(2);
  expect_maps(places[0], {0, 0, 1}, {1, -1, 0});
  expect_maps(places[1], {0, 0, 1}, {2, -1, 0});
  EXPECT_THROW(placement.of(3), CLI::ValidationError);
}

// Inputs far apart come together, whatever origins they have.
TEST(Placement, InputsAreRelativeToOneOrigin) {
  GaussianCloud far = test::random_cloud(5, 1, 0);
  far.origin = {1e6 * 1.024, 0, 0};
  const test::Bytes first = test::ply_of(far, true),
                    second = test::ply_of(test::random_cloud(4, 2, 1));
  std::vector<std::unique_ptr<BlockReader>> readers;
  readers.push_back(open_blocks(std::make_shared<MemorySource>("first", first)));
  readers.push_back(open_blocks(std::make_shared<MemorySource>("second", second)));
  readers = tools::placed(std::move(readers), {parse_transform("translate -1024000 0 0"), {}});
  for (const auto& reader : readers) {
    const GaussianCloud cloud = import_gaussians(*reader);
    EXPECT_EQ(cloud.origin, (std::array<double, 3>{0, 0, 0}));
    for (const float p : cloud.position) EXPECT_LT(std::fabs(p), 11.0f);
  }
}

TEST(Placement, TheOriginIsNearTheMiddleOfAllInputs) {
  std::vector<std::unique_ptr<BlockReader>> readers;
  const test::Bytes ply = test::ply_of(test::random_cloud(4, 2, 1));
  for (int i = 0; i < 2; ++i)
    readers.push_back(open_blocks(std::make_shared<MemorySource>("input", ply)));
  readers = tools::placed(std::move(readers), {{}, parse_transform("translate 102400 0 2048")});
  for (const auto& reader : readers)
    EXPECT_EQ(reader->origin(), (std::array<double, 3>{51200, 0, 0}));
}

}  // namespace
}  // namespace voyager::placement_test
