// A .sog that is written is read again within the format's steps.
#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "runtime/scene/export/morton_order.h"
#include "runtime/scene/export/sog/codebook.h"
#include "runtime/scene/export/sog/sh_sets.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::sog_export_test {
namespace {

test::Bytes sog_of(const GaussianCloud& cloud) {
  test::BytesSink sink;
  const auto writer = write_sog(sink, cloud.size(), cloud.sh_degree, cloud.native);
  writer->append(cloud);
  writer->finish();
  return sink.bytes;
}

GaussianCloud read(const test::Bytes& bytes) {
  return import_gaussians(std::make_shared<MemorySource>("sample.sog", bytes));
}

double mapped(float x) {
  return std::copysign(std::log1p(std::fabs(double{x})), double{x});
}

// Of the mapped positions on each axis.
std::array<double, 3> steps_of(const GaussianCloud& cloud) {
  std::array<double, 3> steps{};
  for (size_t axis = 0; axis < 3; ++axis) {
    double least = INFINITY, most = -INFINITY;
    for (size_t i = axis; i < cloud.position.size(); i += 3)
      least = std::min(least, mapped(cloud.position[i])),
      most = std::max(most, mapped(cloud.position[i]));
    steps[axis] = (most - least) / 65535;
  }
  return steps;
}

double dot(const Quatf& a, const Quatf& b) {
  return std::fabs(double{a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z});
}

// A byte is half a step off in each of three components, of at most sqrt(2) / 255.
constexpr double kRotationError = 1e-4;

TEST(SogExport, ComesBackWithinTheFormatsSteps) {
  for (const int degree : {0, 1, 3}) {
    const GaussianCloud cloud = test::random_cloud(3000, 31, degree, 100.0f);
    const GaussianCloud back = read(sog_of(cloud));
    ASSERT_EQ(back.size(), cloud.size());
    ASSERT_EQ(back.sh_degree, degree);
    const std::vector<uint32_t> order = morton_order(cloud.position);
    const auto steps = steps_of(cloud);
    for (size_t i = 0; i < order.size(); ++i) {
      const size_t from = order[i];
      for (size_t k = 0; k < 3; ++k) {
        const float x = cloud.position[3 * from + k], found = back.position[3 * i + k];
        ASSERT_NEAR(mapped(found), mapped(x), 0.5 * steps[k] + 1e-6);
        ASSERT_NEAR(back.log_scale[3 * i + k], cloud.log_scale[3 * from + k], 0.05);
      }
      const Gaussian a = activate(cloud.words(from), true), b = activate(back.words(i), true);
      ASSERT_GT(dot(a.rotation, b.rotation), 1 - kRotationError);
      ASSERT_NEAR(double{a.opacity}, double{b.opacity}, 0.501 / 255);
    }
  }
}

// As many different sets as the file may have, which 256 values can say.
TEST(SogExport, KeepsColoursThatFitItsTables) {
  GaussianCloud cloud = test::random_cloud(2048, 5, 2);
  for (size_t i = 0; i < cloud.sh.size(); ++i)
    cloud.sh[i] = 0.25f * static_cast<float>((i * 7 + i / 27 * 13) % 9) - 1.0f;
  const GaussianCloud back = read(sog_of(cloud));
  const std::vector<uint32_t> order = morton_order(cloud.position);
  for (size_t i = 0; i < order.size(); ++i)
    for (size_t k = 0; k < 27; ++k)
      ASSERT_NEAR(back.sh[27 * i + k], cloud.sh[size_t{27} * order[i] + k], 1e-6) << i;
}

TEST(SogExport, SaysThatTheSceneHadACompensatedFilter) {
  GaussianCloud cloud = test::random_cloud(10, 5, 0);
  EXPECT_EQ(read(sog_of(cloud)).native, NativeScale{});
  cloud.native = compensated_scale(kLowPass);
  EXPECT_EQ(read(sog_of(cloud)).native, cloud.native);
}

TEST(SogExport, WritesTheSameBytesEachTime) {
  const GaussianCloud cloud = test::random_cloud(500, 5, 1);
  EXPECT_EQ(sog_of(cloud), sog_of(cloud));
}

TEST(SogExport, OneGaussianIsAScene) {
  GaussianCloud cloud = test::random_cloud(1, 5, 3);
  cloud.origin = {1024000, 0, -2048};
  const GaussianCloud back = read(sog_of(cloud));
  ASSERT_EQ(back.size(), 1u);
  for (size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(double{back.position[k]}, cloud.origin[k] + double{cloud.position[k]}, 0.1);
}

TEST(SogExport, HoldsItsCallerToTheAnnouncement) {
  test::BytesSink sink;
  GaussianCloud cloud = test::random_cloud(3, 3, 1);
  EXPECT_THROW(write_sog(sink, 0, 1), Error);
  EXPECT_THROW(write_sog(sink, uint64_t{1} << 29, 1), Error);
  EXPECT_THROW(write_sog(sink, 2, 1)->append(cloud), Error);
  EXPECT_THROW(write_sog(sink, 3, 2)->append(cloud), Error);
  EXPECT_THROW(write_sog(sink, 4, 1)->finish(), Error);
  cloud.sh[5] = NAN;
  EXPECT_THROW(write_sog(sink, 3, 1)->append(cloud), Error);
}

// Against steps between the least and the most.
TEST(SogCodebook, IsFinerThanEvenSteps) {
  std::mt19937 random(7);
  std::normal_distribution<float> normal(0, 1);
  std::vector<float> values(20000);
  for (float& value : values) value = normal(random);
  const sog_export::Codebook codebook = sog_export::codebook_of(values);
  EXPECT_TRUE(std::is_sorted(codebook.begin(), codebook.end()));
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double step = double{*most - *least} / 255;
  double squared = 0;
  for (const float value : values) {
    const float nearest = codebook[sog_export::code_of(codebook, value)];
    for (const float other : codebook)
      ASSERT_LE(std::fabs(value - nearest), std::fabs(value - other));
    squared += double{value - nearest} * double{value - nearest};
  }
  EXPECT_LT(squared / 20000, 0.5 * step * step / 12);
}

TEST(SogShSets, FindsTheSetsThatThereAre) {
  std::vector<float> rows;
  for (size_t i = 0; i < 3000; ++i)
    for (size_t d = 0; d < 9; ++d)
      rows.push_back(static_cast<float>((i % 200 * 31 + d * 17) % 101) + 200.0f * (i % 200 > 99));
  const auto sets = sog_export::sh_sets_of({rows.data(), 3000, 9, 9}, 1024);
  EXPECT_EQ(std::set(sets.labels.begin(), sets.labels.end()).size(), sets.values.size() / 9);
  for (size_t i = 0; i < rows.size(); ++i)
    ASSERT_EQ(sets.values[sets.labels[i / 9] * size_t{9} + i % 9], rows[i]);
}

TEST(SogShSets, AreNoMoreThanAskedForAndTheMeansOfTheirRows) {
  const GaussianCloud cloud = test::random_cloud(5000, 3, 1);
  const auto sets = sog_export::sh_sets_of({cloud.sh.data() + 3, 5000, 9, 12}, 256);
  const size_t count = sets.values.size() / 9;
  EXPECT_LE(count, 256u);
  EXPECT_GT(count, 200u);
  std::vector<double> sums(sets.values.size()), rows(count);
  for (size_t i = 0; i < 5000; ++i) {
    ++rows[sets.labels[i]];
    for (size_t d = 0; d < 9; ++d)
      sums[sets.labels[i] * size_t{9} + d] += double{cloud.sh[12 * i + 3 + d]};
  }
  for (size_t i = 0; i < sums.size(); ++i)
    ASSERT_NEAR(double{sets.values[i]}, sums[i] / rows[i / 9], 1e-5);
}

}  // namespace
}  // namespace voyager::sog_export_test
