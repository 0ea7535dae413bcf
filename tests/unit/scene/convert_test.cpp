#include "runtime/scene/export/convert.h"

#include <algorithm>
#include <limits>

#include "runtime/base/open_source.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::convert_test {
namespace {

// Of bytes that outlive the call.
FlatContents convert_bytes(const test::Bytes& bytes, const std::string& path) {
  Workers workers;
  const auto source = std::make_shared<MemorySource>("sample.bin", bytes);
  return convert([&] { return open_blocks(source); }, path, {}, workers, {});
}

void expect_same_words(const GaussianCloud& a, const GaussianCloud& b) {
  EXPECT_EQ(a.origin, b.origin);
  test::expect_same(a, b);
}

// More than one block, so that a wrong order shows.
TEST(Convert, KeepsWordsAndOrder) {
  const test::TempFolder folder;
  const GaussianCloud cloud = test::random_cloud(20000, 7, 1);
  const FlatContents contents = convert_bytes(test::ply_of(cloud), folder.file("out.ply"));
  EXPECT_EQ(contents.count, cloud.size());
  expect_same_words(test::import_file(folder.file("out.ply")), cloud);
}

TEST(Convert, KeepsTheWorldPositionsOfDoubles) {
  const test::TempFolder folder;
  GaussianCloud cloud = test::random_cloud(300, 8, 0);
  cloud.origin = {4404.0 * 1024, 0.0, -1024.0 * 17};
  convert_bytes(test::ply_of(cloud, true), folder.file("out.ply"));
  const GaussianCloud read = test::import_file(folder.file("out.ply"));
  for (size_t i = 0; i < cloud.position.size(); ++i)
    ASSERT_EQ(read.origin[i % 3] + static_cast<double>(read.position[i]),
              cloud.origin[i % 3] + static_cast<double>(cloud.position[i]));
}

TEST(Convert, LeavesOutWhatIsNotSound) {
  const test::TempFolder folder;
  GaussianCloud cloud = test::random_cloud(100, 9, 0);
  cloud.position[3 * 50] = std::numeric_limits<float>::quiet_NaN();
  cloud.opacity[60] = std::numeric_limits<float>::quiet_NaN();
  const FlatContents contents = convert_bytes(test::ply_of(cloud), folder.file("out.ply"));
  EXPECT_EQ(contents.count, 98u);
  EXPECT_EQ(contents.report.dropped_position, 1u);
  EXPECT_EQ(contents.report.dropped_opacity, 1u);
  EXPECT_EQ(test::import_file(folder.file("out.ply")).size(), 98u);
}

TEST(Convert, KeepsTheFilterOfTheTraining) {
  const test::TempFolder folder;
  test::BytesSink sink;
  const auto writer = write_ply(sink, 20, 1, false, compensated_scale(kLowPass));
  writer->append(test::random_cloud(20, 3, 1));
  writer->finish();
  for (const char* name : {"out.ply", "out.spz"}) {
    convert_bytes(sink.bytes, folder.file(name));
    EXPECT_EQ(test::import_file(folder.file(name)).native, compensated_scale(kLowPass)) << name;
  }
}

TEST(Convert, ABrokenInputLeavesNoFile) {
  const test::TempFolder folder;
  test::Bytes bytes = test::ply_of(test::random_cloud(20000, 7, 0));
  bytes.resize(bytes.size() - 1);
  EXPECT_NE(test::refusal_of([&] { convert_bytes(bytes, folder.file("out.ply")); }), "");
  EXPECT_FALSE(std::filesystem::exists(folder.file("out.ply")));
}

TEST(Convert, ANameOfNoFormatIsRefused) {
  const test::TempFolder folder;
  const test::Bytes bytes = test::ply_of(test::random_cloud(3, 7, 0));
  for (const char* name : {"out", "out.foo", "ply"})
    EXPECT_THROW(convert_bytes(bytes, folder.file(name)), Error) << name;
}

}  // namespace
}  // namespace voyager::convert_test
