#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::ply_export_test {
namespace {

TEST(PlyExport, ComesBackToTheBit) {
  for (const int degree : {0, 1, 2, 3}) {
    const GaussianCloud cloud = test::random_cloud(257, 21, degree);
    test::expect_same(test::import_bytes(test::ply_of(cloud)), cloud);
  }
}

// INRIA's own readers take f_rest by position in the list: all red, all green, all blue.
TEST(PlyExport, StoresShByChannel) {
  GaussianCloud cloud = test::random_cloud(1, 21, 1);
  for (size_t i = 0; i < 12; ++i) cloud.sh[i] = static_cast<float>(i);
  const test::Bytes bytes = test::ply_of(cloud);
  const float* row = nullptr;
  test::Bytes tail(bytes.end() - 26 * 4, bytes.end());
  row = reinterpret_cast<const float*>(tail.data());
  const float expected[12] = {0, 1, 2, 3, 6, 9, 4, 7, 10, 5, 8, 11};
  for (size_t i = 0; i < 12; ++i) EXPECT_EQ(row[6 + i], expected[i]) << i;
}

TEST(PlyExport, BatchesMakeTheSameFile) {
  const GaussianCloud first = test::random_cloud(10, 1, 1), second = test::random_cloud(20, 2, 1);
  test::BytesSink sink;
  const auto writer = write_ply(sink, 30, 1);
  writer->append(first);
  writer->append(GaussianCloud());
  writer->append(second);
  writer->finish();
  const GaussianCloud read = test::import_bytes(sink.bytes);
  ASSERT_EQ(read.size(), 30u);
  EXPECT_TRUE(std::equal(first.sh.begin(), first.sh.end(), read.sh.begin()));
  EXPECT_TRUE(std::equal(second.sh.begin(), second.sh.end(), read.sh.begin() + 120));
}

TEST(PlyExport, DoublesHoldTheWorldPosition) {
  GaussianCloud cloud = test::random_cloud(20, 3, 0);
  cloud.origin = {4404.0 * 1024, 0.0, -1024.0 * 17};
  const GaussianCloud read = test::import_bytes(test::ply_of(cloud, true));
  for (size_t i = 0; i < cloud.position.size(); ++i)
    EXPECT_EQ(read.origin[i % 3] + static_cast<double>(read.position[i]),
              cloud.origin[i % 3] + static_cast<double>(cloud.position[i]));
  EXPECT_THROW(test::ply_of(cloud, false), Error);
}

// However it is read; and that of one which was not nothing is said.
TEST(PlyExport, SaysWhatCompensatedFilterASceneWasTrainedWith) {
  const GaussianCloud cloud = test::random_cloud(20, 3, 1);
  for (const NativeScale& native :
       {compensated_scale(kLowPass), compensated_scale(kMipSplattingLowPass), NativeScale{}}) {
    test::BytesSink sink;
    const auto writer = write_ply(sink, 20, 1, false, native);
    writer->append(cloud);
    writer->finish();
    EXPECT_EQ(test::import_bytes(sink.bytes).native, native);
    EXPECT_EQ(test::import_piped(sink.bytes).native, native);
  }
}

TEST(PlyExport, HoldsItsCallerToTheAnnouncement) {
  test::BytesSink sink;
  const GaussianCloud cloud = test::random_cloud(3, 3, 1);
  EXPECT_THROW(write_ply(sink, 2, 1)->append(cloud), Error);
  EXPECT_THROW(write_ply(sink, 3, 2)->append(cloud), Error);
  EXPECT_THROW(write_ply(sink, 3, 4), Error);
  const auto writer = write_ply(sink, 4, 1);
  writer->append(cloud);
  EXPECT_THROW(writer->finish(), Error);
}

}  // namespace
}  // namespace voyager::ply_export_test
