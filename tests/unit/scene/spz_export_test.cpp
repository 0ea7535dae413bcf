#include <algorithm>

#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::spz_export_test {
namespace {

void expect_within_a_quantum(const GaussianCloud& cloud, const GaussianCloud& read, float step) {
  ASSERT_EQ(read.size(), cloud.size());
  for (size_t i = 0; i < cloud.position.size(); ++i)
    EXPECT_NEAR(cloud.origin[i % 3] + static_cast<double>(cloud.position[i]),
                static_cast<double>(read.position[i]), static_cast<double>(step) * 0.501);
  for (size_t i = 0; i < cloud.log_scale.size(); ++i)
    EXPECT_NEAR(read.log_scale[i], cloud.log_scale[i], 0.5 / 16 + 1e-6);
  for (size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_NEAR(sigmoid(read.opacity[i]), sigmoid(cloud.opacity[i]), 0.5 / 255 + 1e-6);
    const Quatf a = normalise(cloud.words(i).rotation), b = normalise(read.words(i).rotation);
    const float d = std::fabs(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z);
    EXPECT_GT(d, 1.0f - 4e-6f) << "half a degree is 1e-5";
  }
  const size_t width = static_cast<size_t>(cloud.coefficients()) * 3;
  for (size_t i = 0; i < cloud.sh.size(); ++i)
    EXPECT_NEAR(read.sh[i], cloud.sh[i],
                i % width < 3 ? 0.5 / 255 / 0.15 + 1e-5 : 0.5 / 128 + 1e-6);
}

TEST(SpzExport, ComesBackWithinHalfAStep) {
  for (const int degree : {0, 1, 2, 3}) {
    const GaussianCloud cloud = test::random_cloud(500, 31, degree, 100.0f);
    const GaussianCloud read = test::import_bytes(test::spz_v4(cloud));
    EXPECT_EQ(read.sh_degree, degree);
    expect_within_a_quantum(cloud, read, 1.0f / 4096);
  }
}

// Codes are a fixed point (but for rotations with two components that tie for the largest).
TEST(SpzExport, WritingWhatWasReadLosesNothingMore) {
  const GaussianCloud once = test::import_bytes(test::spz_v4(test::random_cloud(5000, 33, 3)));
  const GaussianCloud twice = test::import_bytes(test::spz_v4(once));
  EXPECT_EQ(twice.position, once.position);
  EXPECT_EQ(twice.log_scale, once.log_scale);
  EXPECT_EQ(twice.opacity, once.opacity);
  EXPECT_EQ(twice.sh, once.sh);
  for (size_t i = 0; i < once.rotation.size(); ++i)
    EXPECT_NEAR(std::fabs(twice.rotation[i]), std::fabs(once.rotation[i]), 0.003);
}

TEST(SpzExport, CoarserStepsForALargerCity) {
  GaussianCloud cloud = test::random_cloud(50, 31, 0, 9000.0f);
  cloud.origin = {1024.0, 0.0, -2048.0};
  cloud.native = compensated_scale(kLowPass);
  test::BytesSink sink;
  const auto writer = write_spz(sink, cloud.size(), 0, 12000.0f);
  writer->append(cloud);
  writer->finish();
  const GaussianCloud read = test::import_bytes(sink.bytes);
  EXPECT_TRUE(read.native.antialiased());
  expect_within_a_quantum(cloud, read, 1.0f / 512);
}

TEST(SpzExport, NeverClampsAPosition) {
  for (const float coordinate : {2049.0f, -2049.0f, std::nanf("")}) {
    GaussianCloud cloud = test::random_cloud(2, 31, 0);
    cloud.position[4] = coordinate;
    try {
      test::spz_v4(cloud);
      ADD_FAILURE() << coordinate;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
      EXPECT_NE(std::string(error.what()).find("Gaussian 1, coordinate y"), std::string::npos)
          << error.what();
    }
  }
}

TEST(SpzExport, BatchesMakeTheSameBytesAsOne) {
  const GaussianCloud cloud = test::random_cloud(9000, 35, 1);
  test::BytesSink sink;
  const auto writer = write_spz(sink, cloud.size(), 1);
  const size_t batch = 3000;
  for (size_t first = 0; first < cloud.size(); first += batch) {
    GaussianCloud part;
    part.sh_degree = 1;
    const auto copy = [&](const auto& from, auto& to, size_t width) {
      const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first * width);
      to.assign(begin, begin + static_cast<std::ptrdiff_t>(batch * width));
    };
    copy(cloud.position, part.position, 3);
    copy(cloud.log_scale, part.log_scale, 3);
    copy(cloud.rotation, part.rotation, 4);
    copy(cloud.opacity, part.opacity, 1);
    copy(cloud.sh, part.sh, 12);
    writer->append(part);
  }
  writer->finish();
  EXPECT_EQ(test::import_bytes(sink.bytes).sh, test::import_bytes(test::spz_v4(cloud)).sh);
  EXPECT_EQ(test::import_bytes(sink.bytes).position,
            test::import_bytes(test::spz_v4(cloud)).position);
}

// Readers of 2025 and before know the one, and both hold the same codes.
TEST(SpzExport, Version3HoldsWhatVersion4Does) {
  for (const int degree : {0, 3}) {
    GaussianCloud cloud = test::random_cloud(5000, 36, degree);
    cloud.native = compensated_scale(kLowPass);
    test::BytesSink sink;
    const auto writer = write_spz(sink, cloud.size(), degree, 2047.0f, 3);
    writer->append(cloud);
    writer->finish();
    ASSERT_EQ(sink.bytes[0], std::byte{0x1f});
    const GaussianCloud a = test::import_bytes(sink.bytes),
                        b = test::import_bytes(test::spz_v4(cloud));
    EXPECT_EQ(a.native, b.native);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.log_scale, b.log_scale);
    EXPECT_EQ(a.rotation, b.rotation);
    EXPECT_EQ(a.opacity, b.opacity);
    EXPECT_EQ(a.sh, b.sh);
  }
}

TEST(SpzExport, HoldsItsCallerToTheAnnouncement) {
  test::BytesSink sink;
  const GaussianCloud cloud = test::random_cloud(3, 3, 1);
  EXPECT_THROW(write_spz(sink, 2, 1)->append(cloud), Error);
  EXPECT_THROW(write_spz(sink, 3, 2)->append(cloud), Error);
  EXPECT_THROW(write_spz(sink, 3, -1), Error);
  EXPECT_THROW(write_spz(sink, 1ull << 32, 0), Error);
  for (const int version : {2, 5}) EXPECT_THROW(write_spz(sink, 3, 1, 2047.0f, version), Error);
  EXPECT_THROW(write_spz(sink, 4, 1)->finish(), Error);
  EXPECT_TRUE(sink.bytes.empty()) << "nothing may be written before everything is known to fit";
}

}  // namespace
}  // namespace voyager::spz_export_test
