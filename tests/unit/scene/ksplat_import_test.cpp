// mkkellogg's .ksplat, made by hand: what each code becomes at each level, and what is refused.
#include "runtime/math/half.h"
#include "runtime/scene/import/block_reader.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::ksplat_import_test {
namespace {

using test::Bytes;

constexpr size_t kHeader = 4096, kSection = 1024;

template <class T>
void set(Bytes& bytes, size_t at, T value) {
  if (bytes.size() < at + sizeof value) bytes.resize(at + sizeof value);
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

struct Sample {
  uint32_t count = 1, unused = 0;
  uint16_t sh_degree = 0;
  std::vector<uint32_t> partial = {};  // lengths of the buckets after the full ones
  uint32_t full = 0, bucket_size = 0;
};

void put_real(Bytes& bytes, int level, float value) {
  if (level == 0)
    test::put(bytes, value);
  else
    test::put(bytes, float_to_half(value));
}

// Row i: position code 1000 i + axis (or that number), scale 2^-i, rotation (i, 0, 1, 0), colour
// (i, 51, 255), alpha 204, and SH values that run.
void put_row(Bytes& bytes, int level, const Sample& sample, uint32_t i) {
  for (uint32_t axis = 0; axis < 3; ++axis)
    if (level == 0)
      test::put(bytes, static_cast<float>(1000 * i + axis));
    else
      test::put(bytes, static_cast<uint16_t>(1000 * i + axis));
  for (int axis = 0; axis < 3; ++axis)
    put_real(bytes, level, std::ldexp(1.0f, -static_cast<int>(i)));
  for (const float v : {static_cast<float>(i), 0.0f, 1.0f, 0.0f}) put_real(bytes, level, v);
  for (const uint32_t v : {i, 51u, 255u, 204u}) test::put(bytes, static_cast<uint8_t>(v));
  for (int k = 0; k < 3 * (sh_coefficients(sample.sh_degree) - 1); ++k)
    if (level == 2)
      test::put(bytes, static_cast<uint8_t>(10 * k));
    else
      put_real(bytes, level, static_cast<float>(k) / 8);
}

void put_section_header(Bytes& bytes, size_t at, int level, const Sample& sample) {
  const auto partial = static_cast<uint32_t>(sample.partial.size());
  set(bytes, at, sample.count);
  set(bytes, at + 4, sample.count + sample.unused);
  set(bytes, at + 8, sample.bucket_size);
  set(bytes, at + 12, sample.full + partial);
  set(bytes, at + 16, 5.0f);
  set(bytes, at + 20, uint16_t{12});
  set(bytes, at + 24, level == 0 ? 1u : 32767u);
  set(bytes, at + 32, sample.full);
  set(bytes, at + 36, partial);
  set(bytes, at + 40, sample.sh_degree);
}

Bytes file_of(int level, const std::vector<Sample>& sections) {
  Bytes bytes(kHeader + kSection * sections.size());
  uint32_t count = 0;
  for (const Sample& sample : sections) count += sample.count;
  set(bytes, 1, uint8_t{1});
  set(bytes, 4, static_cast<uint32_t>(sections.size()));
  set(bytes, 12, count);
  set(bytes, 16, count);
  set(bytes, 20, static_cast<uint16_t>(level));
  set(bytes, 36, -1.0f);
  set(bytes, 40, 1.0f);
  for (size_t s = 0; s < sections.size(); ++s) {
    put_section_header(bytes, kHeader + kSection * s, level, sections[s]);
    for (const uint32_t length : sections[s].partial) test::put(bytes, length);
    for (size_t b = 0; b < sections[s].full + sections[s].partial.size(); ++b)
      for (int axis = 0; axis < 3; ++axis) test::put(bytes, static_cast<float>(100 * b));
    for (uint32_t i = 0; i < sections[s].count + sections[s].unused; ++i)
      put_row(bytes, level, sections[s], i);
  }
  return bytes;
}

GaussianCloud import_ksplat(const Bytes& bytes) {
  return import_gaussians(std::make_shared<MemorySource>("sample.ksplat", bytes));
}

void expect_refused(const Bytes& bytes, const std::string& part) {
  const std::string message = test::refusal_of([&] { import_ksplat(bytes); });
  EXPECT_EQ(message.rfind("sample.ksplat: offset ", 0), 0u) << message;
  EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
}

TEST(KsplatImport, DecodesEveryFieldAtEveryLevel) {
  for (int level = 0; level <= 2; ++level) {
    const GaussianCloud cloud = import_ksplat(file_of(level, {{.count = 2, .partial = {2}}}));
    ASSERT_EQ(cloud.size(), 2u) << level;
    const double y = level == 0 ? 1001 : (1001 - 32767) / 32767.0 * 2.5;
    EXPECT_NEAR(cloud.position[4], y, 1e-6) << level;
    EXPECT_NEAR(cloud.log_scale[3], std::log(0.5), 1e-6);
    EXPECT_EQ(cloud.rotation[4], 1.0f);
    EXPECT_EQ(cloud.rotation[6], 1.0f);
    EXPECT_NEAR(cloud.sh[3], (1 / 255.0 - 0.5) / kSh0, 1e-6);
    EXPECT_NEAR(cloud.sh[4], -0.3 / kSh0, 1e-6);
    EXPECT_NEAR(cloud.opacity[1], std::log(4.0), 1e-5);
  }
}

// Each band has all red values, then all green, then all blue.
TEST(KsplatImport, ShBandsFollowOneAnotherChannelByChannel) {
  for (int level = 0; level <= 2; ++level) {
    const GaussianCloud cloud = import_ksplat(file_of(level, {{.sh_degree = 2, .partial = {1}}}));
    ASSERT_EQ(cloud.sh_degree, 2);
    const auto expected = [&](int k) { return level == 2 ? -1 + 2 * 10 * k / 255.0 : k / 8.0; };
    const auto found = [&](size_t k, size_t channel) { return cloud.sh[3 * k + channel]; };
    EXPECT_NEAR(found(1, 0), expected(0), 1e-6) << level;
    EXPECT_NEAR(found(3, 0), expected(2), 1e-6);
    EXPECT_NEAR(found(1, 1), expected(3), 1e-6);
    EXPECT_NEAR(found(3, 2), expected(8), 1e-6);
    EXPECT_NEAR(found(4, 0), expected(9), 1e-6);
    EXPECT_NEAR(found(8, 0), expected(13), 1e-6);
    EXPECT_NEAR(found(4, 1), expected(14), 1e-6);
    EXPECT_NEAR(found(8, 2), expected(23), 1e-6);
  }
}

// Full buckets come first; the others say how many Gaussians they have, which may be none.
TEST(KsplatImport, PositionsAreToldByTheCentreOfTheirBucket) {
  const GaussianCloud cloud =
      import_ksplat(file_of(1, {{.count = 8, .partial = {1, 0, 3}, .full = 2, .bucket_size = 2}}));
  const double centres[8] = {0, 0, 100, 100, 200, 400, 400, 400};
  for (size_t i = 0; i < 8; ++i)
    EXPECT_NEAR(cloud.position[3 * i],
                centres[i] + (1000.0 * static_cast<double>(i) - 32767) / 32767 * 2.5, 1e-4);
  expect_refused(file_of(1, {{.count = 8, .partial = {1, 0, 2}, .full = 2, .bucket_size = 2}}),
                 "buckets");
}

TEST(KsplatImport, SectionsOfDifferentDegreesAndUnusedRowsAgreeWithBlocks) {
  for (int level = 0; level <= 2; ++level) {
    const Bytes bytes = file_of(level, {{.count = 3, .unused = 2, .partial = {3}},
                                        {.count = 0, .unused = 1},
                                        {.count = 4, .sh_degree = 1, .partial = {4}}});
    const GaussianCloud whole = import_ksplat(bytes);
    ASSERT_EQ(whole.size(), 7u);
    ASSERT_EQ(whole.sh_degree, 1);
    EXPECT_EQ(whole.sh[3], 0.0f);
    EXPECT_EQ(whole.sh[12 * 3 + 6], level == 2 ? -1 + 20 / 255.0f : 0.125f);
    const auto reader = open_blocks(std::make_shared<MemorySource>("sample.ksplat", bytes));
    size_t at = 0;
    for (RawBlock block = reader->next(2); block.count > 0; block = reader->next(2)) {
      const GaussianCloud part = reader->decode(block);
      for (size_t i = 0; i < part.position.size(); ++i)
        EXPECT_EQ(part.position[i], whole.position[3 * at + i]);
      at += block.count;
    }
    EXPECT_EQ(at, 7u);
  }
}

TEST(KsplatImport, RefusesEveryHeaderFieldOutOfRange) {
  const Bytes good = file_of(1, {{.count = 2, .partial = {2}}});
  const auto with = [&](size_t at, auto value) {
    Bytes bytes = good;
    set(bytes, at, value);
    return bytes;
  };
  expect_refused(with(0, uint8_t{1}), "major version");
  expect_refused(with(1, uint8_t{0}), "minor version");
  expect_refused(with(4, 0u), "sections");
  expect_refused(with(4, ~0u), "section 1");
  expect_refused(with(16, 3u), "sections");
  expect_refused(with(20, uint16_t{3}), "compression level");
  expect_refused(with(kHeader, 3u), "Gaussians");
  expect_refused(with(kHeader + 4, 3u), "bytes");
  expect_refused(with(kHeader + 4, ~0u), "bytes");
  expect_refused(with(kHeader + 12, 0u), "partly filled buckets");
  expect_refused(with(kHeader + 12, ~0u), "bytes");
  expect_refused(with(kHeader + 20, uint16_t{8}), "bytes of a bucket");
  expect_refused(with(kHeader + 32, 5u), "full buckets");
  expect_refused(with(kHeader + 36, 5u), "partly filled buckets");
  expect_refused(with(kHeader + 40, uint16_t{3}), "SH degree");
}

// A truncation within the padding of a header is one like another.
TEST(KsplatImport, RefusesEveryTruncationAndTrailingBytes) {
  const Bytes whole = file_of(1, {{.count = 2, .sh_degree = 1, .partial = {2}}});
  for (size_t size = 0; size < whole.size(); size += size < kHeader + kSection ? 61 : 1)
    expect_refused(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)),
                   "bytes");
  Bytes longer = whole;
  longer.push_back(std::byte{0});
  expect_refused(longer, "bytes");
}

TEST(KsplatImport, NoFlippedByteCrashes) {
  for (int level = 0; level <= 2; ++level)
    test::expect_flips_are_harmless(
        file_of(level, {{.count = 2, .sh_degree = 1, .partial = {1, 1}}}), import_ksplat);
}

}  // namespace
}  // namespace voyager::ksplat_import_test
