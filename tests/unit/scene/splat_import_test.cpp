// antimatter15's .splat: told by its name, rows of 32 bytes.
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/sanitise.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::splat_import_test {
namespace {

using test::Bytes;

GaussianCloud import_splat(const Bytes& bytes) {
  return import_gaussians(std::make_shared<MemorySource>("sample.splat", bytes));
}

void add_row(Bytes& bytes, std::initializer_list<float> floats, std::initializer_list<int> codes) {
  for (const float v : floats) test::put(bytes, v);
  for (const int v : codes) bytes.push_back(static_cast<std::byte>(v));
}

Bytes two_rows() {
  Bytes bytes;
  add_row(bytes, {1, -2, 3.5f, 1, 0.5f, 1e-6f}, {255, 0, 51, 204, 255, 0, 128, 127});
  add_row(bytes, {4, 5, 6, 0, 2, 3}, {1, 2, 3, 255, 0, 255, 127, 128});
  return bytes;
}

TEST(SplatImport, DecodesEachField) {
  const GaussianCloud cloud = import_splat(two_rows());
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(cloud.sh_degree, 0);
  EXPECT_EQ(cloud.position[1], -2.0f);
  EXPECT_EQ(cloud.log_scale[0], 0.0f);
  EXPECT_NEAR(cloud.log_scale[1], std::log(0.5), 1e-6);
  EXPECT_NEAR(cloud.log_scale[2], std::log(1e-6), 1e-5);
  EXPECT_NEAR(cloud.sh[0], 0.5 / kSh0, 1e-6);
  EXPECT_NEAR(cloud.sh[1], -0.5 / kSh0, 1e-6);
  EXPECT_NEAR(cloud.sh[2], -0.3 / kSh0, 1e-6);
  EXPECT_NEAR(cloud.opacity[0], std::log(4.0), 1e-5);
  EXPECT_EQ(cloud.rotation[0], 127 / 128.0f);
  EXPECT_EQ(cloud.rotation[1], -1.0f);
  EXPECT_EQ(cloud.rotation[2], 0.0f);
  EXPECT_EQ(cloud.rotation[3], -1 / 128.0f);
}

TEST(SplatImport, ExtremeAlphasAreNotRepairsAndAScaleOfZeroIs) {
  Bytes bytes = two_rows();
  bytes[27] = std::byte{0};
  const GaussianCloud cloud = import_splat(bytes);
  EXPECT_EQ(cloud.opacity[0], -kMaxLogit);
  EXPECT_EQ(cloud.opacity[1], kMaxLogit);
  EXPECT_EQ(cloud.log_scale[3], kMinLogScale);
  EXPECT_EQ(cloud.report.repaired_scale, 1u);
  EXPECT_EQ(cloud.report.repaired(), 1u);
}

TEST(SplatImport, ANegativeScaleDropsTheGaussian) {
  Bytes bytes = two_rows();
  const float scale = -1;
  std::memcpy(bytes.data() + 12, &scale, sizeof scale);
  const GaussianCloud cloud = import_splat(bytes);
  EXPECT_EQ(cloud.size(), 1u);
  EXPECT_EQ(cloud.report.dropped_scale, 1u);
}

// Its bytes say nothing: any may begin a row, those of another format too.
TEST(SplatImport, IsToldByItsNameAlone) {
  const Bytes rows = two_rows();
  EXPECT_TRUE(is_importable(rows, "a.splat"));
  EXPECT_TRUE(is_importable(rows, "https://host/A.SPLAT"));
  EXPECT_FALSE(is_importable(rows, "a.splat.bin"));
  EXPECT_FALSE(is_importable(rows, "splat"));
  Bytes zip_like = rows;
  std::memcpy(zip_like.data(), "\x1f\x8b", 2);
  EXPECT_EQ(import_splat(zip_like).size(), 2u);
  test::expect_refused(rows, "format", "without a name");
}

TEST(SplatImport, BlocksAgreeWithTheWhole) {
  const Bytes bytes = two_rows();
  const GaussianCloud whole = import_splat(bytes);
  const auto reader = open_blocks(std::make_shared<MemorySource>("sample.splat", bytes));
  EXPECT_EQ(reader->count(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    const GaussianCloud one = reader->decode(reader->next(1));
    EXPECT_EQ(one.position[0], whole.position[3 * i]);
    EXPECT_EQ(one.rotation[3], whole.rotation[4 * i + 3]);
  }
  EXPECT_EQ(reader->next(1).count, 0u);
}

TEST(SplatImport, RefusesALengthThatIsNoMultipleOfARow) {
  const Bytes whole = two_rows();
  for (size_t size = 0; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    if (size == 32) {
      EXPECT_EQ(import_splat(cut).size(), 1u);
      continue;
    }
    const std::string message = test::refusal_of([&] { import_splat(cut); });
    EXPECT_NE(message.find("multiple of 32"), std::string::npos) << size << message;
  }
}

TEST(SplatImport, NoFlippedByteCrashes) {
  test::expect_flips_are_harmless(two_rows(), import_splat);
}

}  // namespace
}  // namespace voyager::splat_import_test
