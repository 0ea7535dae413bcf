#include <algorithm>
#include <cstring>
#include <span>

#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/import_blocks.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::splat_export_test {
namespace {

struct Row {
  float position[3], scale[3];
  uint8_t colour[4], rotation[4];
};

std::vector<Row> rows_of(const GaussianCloud& cloud) {
  test::BytesSink sink;
  const auto writer = write_splat(sink, cloud.size(), cloud.sh_degree);
  writer->append(cloud);
  writer->finish();
  std::vector<Row> rows(sink.bytes.size() / sizeof(Row));
  EXPECT_EQ(sink.bytes.size(), cloud.size() * kSplatBytes);
  std::memcpy(rows.data(), sink.bytes.data(), rows.size() * sizeof(Row));
  return rows;
}

double colour_of(const GaussianCloud& cloud, size_t i, size_t channel) {
  const double f_dc = double{cloud.sh[i * static_cast<size_t>(cloud.coefficients()) * 3 + channel]};
  return std::clamp(0.5 + kSh0 * f_dc, 0.0, 1.0);
}

TEST(SplatExport, ComesBackWithinHalfAStep) {
  for (const int degree : {0, 3}) {
    const GaussianCloud cloud = test::random_cloud(40000, 31, degree, 100.0f);
    const std::vector<Row> rows = rows_of(cloud);
    for (size_t i = 0; i < rows.size(); ++i) {
      const Row& row = rows[i];
      const Gaussian g = activate(cloud.words(i), true);
      for (size_t k = 0; k < 3; ++k) {
        ASSERT_EQ(row.position[k], cloud.position[3 * i + k]);
        ASSERT_EQ(row.scale[k], g.scale[static_cast<int>(k)]);
        ASSERT_NEAR(row.colour[k] / 255.0, colour_of(cloud, i, k), 0.5 / 255 + 1e-6);
      }
      ASSERT_NEAR(row.colour[3] / 255.0, double{g.opacity}, 0.5 / 255 + 1e-6);
      const float q[4] = {g.rotation.w, g.rotation.x, g.rotation.y, g.rotation.z};
      for (int k = 0; k < 4; ++k)
        ASSERT_NEAR((row.rotation[k] - 128) / 128.0, std::min(q[k], 127.0f / 128),
                    0.5 / 128 + 1e-6);
    }
  }
}

GaussianCloud read_rows(const std::vector<Row>& rows) {
  const MemorySource source("a.splat", std::as_bytes(std::span(rows)));
  return import_blocks(*open_splat_blocks(read_source(source)), {});
}

TEST(SplatExport, RotationsThatAreWrittenAgainDoNotWander) {
  const std::vector<Row> first = rows_of(test::random_cloud(2000, 33, 0));
  std::vector<Row> rows = first;
  for (int again = 0; again < 5; ++again) rows = rows_of(read_rows(rows));
  for (size_t i = 0; i < rows.size(); ++i)
    for (size_t k = 0; k < 4; ++k)
      ASSERT_NEAR(rows[i].rotation[k], first[i].rotation[k], 1) << i << " " << k;
}

TEST(SplatExport, PositionsAreOfTheWorld) {
  GaussianCloud cloud = test::random_cloud(1, 31, 0);
  cloud.origin = {1024.0, 0.0, -2048.0};
  const Row row = rows_of(cloud).front();
  for (size_t k = 0; k < 3; ++k)
    EXPECT_EQ(row.position[k], static_cast<float>(cloud.origin[k] + double{cloud.position[k]}));
}

TEST(SplatExport, HoldsItsCallerToTheAnnouncement) {
  test::BytesSink sink;
  const GaussianCloud cloud = test::random_cloud(3, 3, 1);
  EXPECT_THROW(write_splat(sink, 2, 1)->append(cloud), Error);
  EXPECT_THROW(write_splat(sink, 3, 2)->append(cloud), Error);
  EXPECT_THROW(write_splat(sink, 4, 1)->finish(), Error);
}

}  // namespace
}  // namespace voyager::splat_export_test
