#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/spz_extensions.h"
#include "runtime/scene/sanitise.h"
#include "runtime/scene/spz_format.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::spz_import_test {
namespace {

using test::Bytes;

Bytes header_of(uint32_t version, uint32_t count, uint8_t sh_degree, uint8_t bits) {
  Bytes bytes;
  test::put<uint32_t>(bytes, spz::kMagic);
  test::put<uint32_t>(bytes, version);
  test::put<uint32_t>(bytes, count);
  for (const uint8_t field : {sh_degree, bits, uint8_t{0}, uint8_t{0}}) test::put(bytes, field);
  return bytes;
}

void add(Bytes& bytes, std::initializer_list<int> values) {
  for (const int v : values) bytes.push_back(static_cast<std::byte>(v));
}

template <class T>
Bytes with(Bytes bytes, size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof(T));
  return bytes;
}

// The codes of version 2 and what each must become, in INRIA axes.
TEST(SpzImport, DecodesVersion2) {
  Bytes bytes = header_of(2, 1, 1, 8);
  add(bytes, {0x80, 1, 0, 0x00, 0xff, 0xff, 0x40, 0, 0});  // 1.5, -1, 0.25 up and back
  add(bytes, {51, 255, 128, 0});                           // alpha 0.2; colours
  add(bytes, {160, 0, 255});                               // scales
  add(bytes, {255, 128, 127});                             // x = 1, the rest near 0
  add(bytes, {0, 64, 128, 192, 255, 128, 129, 127, 128});  // SH y, z, x by rgb
  const GaussianCloud cloud = test::import_bytes(test::gzip(bytes));
  ASSERT_EQ(cloud.size(), 1u);
  EXPECT_EQ(cloud.position[0], 1.5f);
  EXPECT_EQ(cloud.position[1], 1.0f);
  EXPECT_EQ(cloud.position[2], -0.25f);
  EXPECT_NEAR(cloud.opacity[0], std::log(0.2 / 0.8), 1e-6);
  EXPECT_NEAR(cloud.sh[0], 0.5 / 0.15, 1e-6);
  EXPECT_NEAR(cloud.sh[1], (128 / 255.0 - 0.5) / 0.15, 1e-6);
  EXPECT_NEAR(cloud.sh[2], -0.5 / 0.15, 1e-6);
  EXPECT_EQ(cloud.log_scale[0], 0.0f);
  EXPECT_EQ(cloud.log_scale[1], -10.0f);
  EXPECT_EQ(cloud.log_scale[2], 255 / 16.0f - 10.0f);
  EXPECT_NEAR(cloud.rotation[0], 0.0f, 1e-6);
  EXPECT_NEAR(cloud.rotation[1], 1.0f, 1e-6);
  EXPECT_NEAR(cloud.rotation[2], -1 / 255.0, 1e-6);
  EXPECT_NEAR(cloud.rotation[3], 1 / 255.0, 1e-6);
  const float sh[9] = {1.0f, 0.5f, 0.0f, -0.5f, -127 / 128.0f, 0.0f, 1 / 128.0f, -1 / 128.0f, 0.0f};
  for (size_t i = 0; i < 9; ++i) EXPECT_EQ(cloud.sh[3 + i], sh[i]) << i;
  EXPECT_EQ(cloud.report.repaired() + cloud.report.dropped(), 0u);
}

TEST(SpzImport, DecodesHalfFloatsOfVersion1) {
  Bytes bytes = header_of(1, 2, 0, 12);
  for (const uint16_t half : {0x3c00, 0xc500, 0x0001, 0x7bff, 0x8000, 0x3555})
    test::put(bytes, half);
  bytes.resize(bytes.size() + 2 * 10);
  const GaussianCloud cloud = test::import_bytes(bytes);
  const float expected[6] = {1.0f, 5.0f, -5.9604645e-8f, 65504.0f, 0.0f, -0.333251953125f};
  for (size_t i = 0; i < 6; ++i) EXPECT_EQ(cloud.position[i], expected[i]) << i;
}

TEST(SpzImport, SmallestThreeRotationsAreUnit) {
  Bytes bytes = header_of(3, 3, 0, 12);
  bytes.resize(bytes.size() + 3 * 16);
  // The largest is w, then y, then x; the others in x, y, z, w order from the top.
  for (const uint32_t code :
       {3u << 30 | 511u << 20 | 0u << 10 | 0u, 1u << 30 | (512u + 255u) << 20 | 0u << 10 | 100u,
        0u << 30 | 511u << 20 | 511u << 10 | 511u})
    test::put(bytes, code);
  const GaussianCloud cloud = test::import_bytes(test::gzip(bytes));
  const float half = std::sqrt(0.5f);
  EXPECT_NEAR(cloud.rotation[0], half, 1e-6);
  EXPECT_NEAR(cloud.rotation[1], half, 1e-6);
  EXPECT_NEAR(cloud.rotation[4], 100 / 511.0 * half, 1e-6);
  EXPECT_NEAR(cloud.rotation[5], -255 / 511.0 * half, 1e-6);
  EXPECT_LT(cloud.rotation[6], -0.9f);
  for (const float v : cloud.rotation) EXPECT_TRUE(std::isfinite(v));
}

// Alphas 0 and 255 are ordinary codes: their logits are bounded, and no repair.
TEST(SpzImport, ExtremeAlphasAreNotRepairs) {
  Bytes bytes = header_of(3, 2, 0, 12);
  bytes.resize(bytes.size() + 18);
  add(bytes, {0, 255});
  bytes.resize(bytes.size() + 20);
  const GaussianCloud cloud = test::import_bytes(bytes);
  EXPECT_EQ(cloud.opacity[0], -kMaxLogit);
  EXPECT_EQ(cloud.opacity[1], kMaxLogit);
  EXPECT_EQ(cloud.report.repaired(), 0u);
}

// A colour seen from d must be what the unconverted coefficients show from the mirrored d.
TEST(SpzImport, ShSignsFollowTheBasis) {
  const Vec3d d = {0.48, -0.6, 0.64}, mirrored = {d.x, -d.y, -d.z};
  double here[16], there[16];
  sh_basis(3, d, here);
  sh_basis(3, mirrored, there);
  for (size_t k = 0; k < 16; ++k) {
    EXPECT_GT(std::fabs(here[k]), 1e-3);
    EXPECT_NEAR(there[k], spz::kToInria.sh[k] * here[k], 1e-12) << k;
  }
  const Bytes file = test::planar_spz(3, 5, 3);
  const GaussianCloud cloud = test::import_bytes(file);
  const std::byte* codes = file.data() + spz::kHeaderBytes + 5 * 20;
  for (size_t i = 0; i < cloud.size(); ++i) {
    const auto stored = [&](int k, int channel) {
      if (k == 0) return static_cast<double>(cloud.sh[48 * i + static_cast<size_t>(channel)]);
      return (std::to_integer<int>(codes[45 * i + static_cast<size_t>(3 * (k - 1) + channel)]) -
              128) /
             128.0;
    };
    const auto converted = [&](int k, int channel) {
      return static_cast<double>(cloud.sh[48 * i + static_cast<size_t>(3 * k + channel)]);
    };
    const Vec3d a = sh_colour(3, d, converted), b = sh_colour(3, mirrored, stored);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-9);
  }
}

TEST(SpzImport, FlagsAndExtensions) {
  EXPECT_FALSE(test::import_bytes(test::planar_spz(3, 2, 1, 0)).native.antialiased());
  EXPECT_TRUE(test::import_bytes(test::planar_spz(3, 2, 1, 1)).native.antialiased());
  Bytes planar = test::planar_spz(3, 2, 1, 2);
  planar.resize(planar.size() + 33);
  EXPECT_EQ(test::import_bytes(planar).size(), 2u);
  EXPECT_EQ(test::import_piped(test::gzip(planar)).size(), 2u);
  // Version 4 keeps them between the header and the table.
  const GaussianCloud cloud = test::random_cloud(4, 2, 1);
  Bytes v4 = with<uint32_t>(with<uint8_t>(test::spz_v4(cloud), 14, 3), 16, 32 + 21);
  v4.insert(v4.begin() + 32, 21, std::byte{7});
  const GaussianCloud read = test::import_bytes(v4);
  EXPECT_EQ(read.size(), 4u);
  EXPECT_TRUE(read.native.antialiased());
  EXPECT_EQ(read.sh, test::import_bytes(test::spz_v4(cloud)).sh);
}

void put_record(Bytes& bytes, uint32_t type, const Bytes& payload) {
  test::put<uint32_t>(bytes, type);
  test::put<uint32_t>(bytes, static_cast<uint32_t>(payload.size()));
  bytes.insert(bytes.end(), payload.begin(), payload.end());
}

Bytes record_of_axes(uint32_t system) {
  Bytes payload, record;
  test::put<uint32_t>(payload, system);
  put_record(record, 0xadbe0003, payload);
  return record;
}

// Version 4 with extensions before its table.
Bytes v4_with(const GaussianCloud& cloud, const Bytes& records) {
  Bytes bytes = with<uint32_t>(with<uint8_t>(test::spz_v4(cloud), 14, 2), 16,
                               32 + static_cast<uint32_t>(records.size()));
  bytes.insert(bytes.begin() + 32, records.begin(), records.end());
  return bytes;
}

std::shared_ptr<const ByteSource> source_of(const Bytes& bytes) {
  return std::make_shared<MemorySource>("sample.spz", bytes);
}

TEST(SpzImport, ExtensionsThatAreNotReadAreNamed) {
  Bytes records;
  put_record(records, 0x4e410001, Bytes(5));
  put_record(records, 0xadbe0002, Bytes(12));
  const Bytes v4 = v4_with(test::random_cloud(3, 2, 1), records);
  Bytes planar = test::planar_spz(3, 2, 1, 2);
  planar.insert(planar.end(), records.begin(), records.end());
  for (const Bytes& bytes : {v4, planar, test::gzip(planar)}) {
    const std::vector<std::string> left = left_out_of(*source_of(bytes));
    ASSERT_EQ(left.size(), 2u);
    EXPECT_NE(left[0].find("0x4e410001 (5 bytes)"), std::string::npos) << left[0];
    EXPECT_NE(left[1].find("SPZ_ADOBE_safe_orbit_camera"), std::string::npos) << left[1];
    EXPECT_GT(test::import_bytes(bytes).size(), 1u);
  }
  EXPECT_TRUE(left_out_of(*source_of(test::planar_spz(3, 2, 3))).empty());
}

// A gzip stream makes a thousand bytes of one: what follows the last attribute is not read on and
// on.
TEST(SpzImport, RefusesMoreThanExtensionsAfterTheRecords) {
  Bytes planar = test::planar_spz(3, 2, 1, 2);
  Bytes all = planar;
  all.resize(planar.size() + spz::kMostExtensionBytes);
  EXPECT_EQ(test::import_bytes(test::gzip(all)).size(), 2u);
  all.resize(all.size() + 1);
  const Bytes more = test::gzip(all);
  test::expect_refused(more, "extensions: found more than 65536 bytes", "after the records");
  EXPECT_NE(test::refusal_of([&] { left_out_of(*source_of(more)); }).find("extensions"),
            std::string::npos);
}

// What deflate can make of the file, were it all zeros.
TEST(SpzImport, RefusesMoreGaussiansThanItsBytesHold) {
  Bytes planar = test::planar_spz(3, 0, 3);
  const uint32_t count = 100'000;
  std::memcpy(planar.data() + 8, &count, sizeof count);
  const Bytes bytes = test::gzip(planar);
  EXPECT_NE(test::refusal_of([&] {
              open_blocks(source_of(bytes));
            }).find("Gaussians: found 100000, expected at most"),
            std::string::npos);
}

// What x, y and z of the file point to, against the usual right, up, back.
TEST(SpzImport, ACoordinateSystemTurnsTheScene) {
  const GaussianCloud usual = test::import_bytes(test::planar_spz(3, 4, 2));
  const auto turned = [&](uint32_t system) {
    Bytes planar = test::planar_spz(3, 4, 2, 2);
    const Bytes record = record_of_axes(system);
    planar.insert(planar.end(), record.begin(), record.end());
    const GaussianCloud whole = test::import_bytes(planar);
    const auto reader = open_blocks(source_of(planar));
    const GaussianCloud block = reader->decode(reader->next(100));
    EXPECT_EQ(whole.position, block.position);
    EXPECT_EQ(whole.sh, block.sh);
    return whole;
  };
  for (const uint32_t same : {0u, 4u}) {
    EXPECT_EQ(turned(same).position, usual.position);
    EXPECT_EQ(turned(same).sh, usual.sh);
  }
  const GaussianCloud ply = turned(6), left_front_up = turned(11);  // RDF, LFU
  for (size_t i = 0; i < usual.size(); ++i) {
    const float* stored = &usual.position[3 * i];
    EXPECT_EQ(ply.position[3 * i], stored[0]);
    EXPECT_EQ(ply.position[3 * i + 1], -stored[1]);
    EXPECT_EQ(ply.position[3 * i + 2], -stored[2]);
    EXPECT_EQ(left_front_up.position[3 * i], -stored[0]);
    EXPECT_EQ(left_front_up.position[3 * i + 1], stored[2]);   // up
    EXPECT_EQ(left_front_up.position[3 * i + 2], -stored[1]);  // front
  }
  for (const uint32_t unknown : {17u, 0xffffffffu}) {
    Bytes planar = test::planar_spz(3, 4, 2, 2);
    const Bytes record = record_of_axes(unknown);
    planar.insert(planar.end(), record.begin(), record.end());
    test::expect_refused(planar, "coordinate system", "unknown axes");
  }
  const GaussianCloud cloud = test::random_cloud(4, 2, 1);
  EXPECT_EQ(test::import_bytes(v4_with(cloud, record_of_axes(6))).position[1],
            -test::import_bytes(test::spz_v4(cloud)).position[1]);
}

// Each Gaussian has 24 coefficients of three channels: the last nine are stepped over.
TEST(SpzImport, ShOfDegreeFourIsCut) {
  const Bytes three = test::planar_spz(3, 3, 3);
  Bytes four = with<uint8_t>(three, 12, 4);
  for (size_t i = 3; i > 0; --i)
    four.insert(four.begin() + static_cast<std::ptrdiff_t>(three.size() - 45 * (3 - i)), 27,
                std::byte{200});
  const GaussianCloud read = test::import_bytes(four), cut = test::import_bytes(three);
  EXPECT_EQ(read.sh_degree, 3);
  EXPECT_EQ(read.sh, cut.sh);
  EXPECT_EQ(read.position, cut.position);
  const auto reader = open_blocks(source_of(four));
  EXPECT_EQ(reader->sh_degree(), 3);
  EXPECT_EQ(reader->decode(reader->next(9)).sh, cut.sh);
  EXPECT_EQ(left_out_of(*source_of(four)),
            std::vector<std::string>{"spherical harmonics of degree 4"});
  test::expect_refused(with<uint8_t>(three, 12, 5), "SH degree", "degree 5");
}

TEST(SpzImport, NoGaussiansIsAScene) {
  EXPECT_EQ(test::import_bytes(test::planar_spz(2, 0, 3)).size(), 0u);
  EXPECT_EQ(test::import_bytes(test::gzip(test::planar_spz(3, 0, 0))).size(), 0u);
  EXPECT_EQ(test::import_bytes(test::spz_v4(test::random_cloud(0, 1, 2))).size(), 0u);
}

std::vector<Bytes> one_of_each() {
  std::vector<Bytes> files;
  for (const uint32_t version : {1u, 2u, 3u}) {
    files.push_back(test::planar_spz(version, 3, 1));
    files.push_back(test::gzip(files.back()));
  }
  files.push_back(test::spz_v4(test::random_cloud(3, 5, 1)));
  files.push_back(test::spz_v4(test::random_cloud(3, 5, 0)));
  return files;
}

TEST(SpzImport, RefusesEveryTruncationAndTrailingBytes) {
  for (const Bytes& whole : one_of_each()) {
    EXPECT_EQ(test::import_bytes(whole).size(), 3u);
    test::expect_refused_in_part(whole);
  }
}

TEST(SpzImport, NoFlippedByteCrashes) {
  for (const Bytes& whole : one_of_each())
    for (size_t at = 0; at < whole.size(); ++at)
      for (const int flip : {1, 0x10, 0x80, 0xff}) {
        Bytes bytes = whole;
        bytes[at] ^= static_cast<std::byte>(flip);
        try {
          EXPECT_LE(test::import_bytes(bytes).size(), 3u);
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ErrorCode::refused_input) << error.what();
        }
      }
}

// Zeros compress to a thousandth: a count is held to the length of the file, whatever would come.
TEST(SpzImport, RefusesMoreGaussiansThanAFileOfItsLengthIsWorth) {
  Bytes bytes = test::planar_spz(3, 0, 0);
  const uint32_t count = 700'000;
  std::memcpy(bytes.data() + 8, &count, sizeof count);
  bytes.resize(16 + size_t{20} * count);
  EXPECT_EQ(test::import_bytes(bytes).size(), count);
  bytes = test::gzip(bytes);
  const std::string expected = "Gaussians: found 700000, expected at most";
  const std::string whole = test::refusal_of([&] { test::import_bytes(bytes); });
  EXPECT_NE(whole.find(expected), std::string::npos) << whole;
  const std::string blocks =
      test::refusal_of([&] { open_blocks(std::make_shared<MemorySource>("sample.bin", bytes)); });
  EXPECT_NE(blocks.find(expected), std::string::npos) << blocks;
}

TEST(SpzImport, RefusesEveryHeaderFieldOutOfRange) {
  for (const Bytes& good : {test::planar_spz(2, 3, 1), test::planar_spz(3, 3, 1)}) {
    const std::vector<std::pair<Bytes, std::string>> bad = {
        {with<uint32_t>(good, 4, 0), "version"},     {with<uint32_t>(good, 4, 5), "version"},
        {with<uint32_t>(good, 4, ~0u), "version"},   {with<uint32_t>(good, 8, 1000u), "positions"},
        {with<uint32_t>(good, 8, 4), "bytes"},       {with<uint32_t>(good, 8, 2), "more bytes"},
        {with<uint8_t>(good, 12, 5), "SH degree"},   {with<uint8_t>(good, 12, 255), "SH degree"},
        {with<uint8_t>(good, 12, 2), "sh"},          {with<uint8_t>(good, 12, 0), "more bytes"},
        {with<uint8_t>(good, 13, 25), "fractional"}, {with<uint8_t>(good, 14, 4), "flags"},
        {with<uint8_t>(good, 14, 0x80), "flags"},    {with<uint8_t>(good, 15, 1), "reserved"}};
    for (const auto& [bytes, field] : bad) {
      test::expect_refused(bytes, field, "raw");
      test::expect_refused(test::gzip(bytes), field, "gzip");
    }
    test::expect_refused(test::gzip(with<uint32_t>(good, 0, 7)), "magic", "gzip");
    test::expect_refused(test::gzip(with<uint32_t>(good, 4, 4)), "version",
                         "version 4 is never gzipped");
  }
}

TEST(SpzImport, RefusesEveryStreamTableFieldOutOfRange) {
  const Bytes good = test::spz_v4(test::random_cloud(3, 5, 1));
  const std::vector<std::pair<Bytes, std::string>> bad = {
      {with<uint32_t>(good, 8, 1000u), "uncompressed size"},
      {with<uint32_t>(good, 8, 2), "uncompressed size"},
      {with<uint8_t>(good, 12, 5), "SH degree"},
      {with<uint8_t>(good, 12, 2), "sh: uncompressed size"},
      {with<uint8_t>(good, 13, 60), "fractional bits"},
      {with<uint8_t>(good, 14, 0x44), "flags"},
      {with<uint8_t>(good, 15, 5), "streams"},
      {with<uint8_t>(good, 15, 255), "streams"},
      {with<uint32_t>(good, 16, 31), "offset of the stream table"},
      {with<uint32_t>(good, 16, 33), "offset of the stream table"},
      {with<uint32_t>(with<uint8_t>(good, 14, 2), 16, ~0u), "offset of the stream table"},
      {with<uint32_t>(with<uint8_t>(good, 14, 2), 16, 60000), "before the stream table"},
      {with<uint8_t>(good, 20, 1), "reserved"},
      {with<uint8_t>(good, 31, 1), "reserved"},
      {with<uint64_t>(good, 40, ~0ull), "positions: uncompressed size"},
      {with<uint64_t>(good, 32, ~0ull), ""},
      {with<uint64_t>(good, 32, 0), ""},
      {with<uint64_t>(good, 32 + 5 * 16, 1ull << 40), ""},
  };
  for (const auto& [bytes, field] : bad) test::expect_refused(bytes, field, field);
}

TEST(SpzImport, RefusesDamagedStreams) {
  Bytes gz = test::gzip(test::planar_spz(3, 3, 1));
  gz[gz.size() - 6] ^= std::byte{1};  // the CRC
  test::expect_refused(gz, "compressed stream", "gzip CRC");
  Bytes v4 = test::spz_v4(test::random_cloud(3, 5, 1));
  v4[32 + 6 * 16] ^= std::byte{1};  // the first frame's magic
  test::expect_refused(v4, "compressed stream", "zstd");
}

}  // namespace
}  // namespace voyager::spz_import_test
