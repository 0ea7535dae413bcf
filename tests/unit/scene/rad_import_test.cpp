// Spark's .rad, made by hand: what each encoding becomes, which Gaussians of a tree are read, and
// what is refused.
#include <algorithm>
#include <cmath>

#include "runtime/base/file.h"
#include "runtime/math/byte_code.h"
#include "runtime/scene/import/block_reader.h"
#include "tests/fuzz/memory_folder.h"
#include "tests/support/rad_files.h"
#include "tests/support/test_support.h"

namespace voyager::rad_import_test {
namespace {

using namespace voyager::test;
using Json = nlohmann::json;
using Properties = std::vector<RadProperty>;

GaussianCloud import_rad(const Bytes& bytes) {
  return import_gaussians(std::make_shared<MemorySource>("a.rad", bytes));
}

void expect_refusal(const Bytes& bytes, const std::string& part) {
  const std::string message = refusal_of([&] { import_rad(bytes); });
  EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
  EXPECT_EQ(message.rfind("a.rad: offset ", 0), 0u) << message;
}

GaussianCloud sample(size_t count, int sh_degree) {
  GaussianCloud cloud = random_cloud(count, 9, sh_degree);
  for (size_t i = 0; i < count; ++i) {
    float* q = &cloud.rotation[4 * i];
    const float length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (size_t k = 0; k < 4; ++k) q[k] /= length;
  }
  return cloud;
}

Bytes one_chunk(const Properties& properties, uint64_t count, int sh_degree = 0,
                bool is_tree = false) {
  return rad_file(rad_meta(count, sh_degree, 65536, is_tree), {rad_chunk(0, count, properties)});
}

// Two Gaussians, property by property.
const RadNumbers kCentres{3, {1, 2, 3, -4, 5.5f, -60}}, kAlphas{1, {0.2f, 0.8f}},
    kColours{3, {0, 0.5f, 1, 0.25f, -1, 2}}, kScales{3, {1, 2, 0, 0.5f, 0.25f, 4}},
    kAxes{3, {0.5f, 0, 0, 0.1f, -0.2f, 0.3f}};
Properties in_f32() {
  return {rad_f32("center", kCentres), rad_f32("alpha", kAlphas), rad_f32("rgb", kColours),
          rad_f32("scales", kScales), rad_f32("orientation", kAxes)};
}

void expect_the_two(const GaussianCloud& cloud, double step) {
  ASSERT_EQ(cloud.size(), 2u);
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(cloud.position[i], kCentres.values[i], 30 * step) << i;
    EXPECT_NEAR(cloud.sh[i], (kColours.values[i] - 0.5) / 0.28209479177387814, 10 * step) << i;
    const float scale = kScales.values[i];
    if (scale > 0) {
      EXPECT_NEAR(cloud.log_scale[i], std::log(scale), 20 * step + 1e-6) << i;
    }
    EXPECT_NEAR(cloud.rotation[4 * (i / 3) + 1 + i % 3], kAxes.values[i], step + 1e-6) << i;
  }
  EXPECT_NEAR(cloud.opacity[0], std::log(0.25), 8 * step + 1e-6);
  EXPECT_NEAR(cloud.opacity[1], std::log(4.0), 8 * step + 1e-6);
  EXPECT_NEAR(cloud.rotation[0], std::sqrt(0.75), step + 1e-6);
  EXPECT_LT(cloud.log_scale[2], -20);  // a scale of 0
}

TEST(RadImport, NumbersOfAnyWidthAreThoseOfTheProperty) {
  expect_the_two(import_rad(one_chunk(in_f32(), 2)), 1e-7);
  Properties properties = in_f32();
  for (RadProperty& property : properties) property.is_deflated = false;
  properties[0] = rad_lebytes(rad_f32("center", kCentres));
  expect_the_two(import_rad(one_chunk(properties, 2)), 1e-7);
  RadNumbers logarithms = kScales;
  for (float& v : logarithms.values) v = std::log(v);
  RadProperty scales = rad_f16("scales", logarithms);
  scales.encoding = "ln_f16";
  properties = {rad_f16("center", kCentres), rad_f16("alpha", kAlphas), rad_f16("rgb", kColours),
                scales, rad_f16("orientation", kAxes)};
  expect_the_two(import_rad(one_chunk(properties, 2)), 1e-3);
  properties[0] = rad_lebytes(rad_f16("center", kCentres));
  expect_the_two(import_rad(one_chunk(properties, 2)), 1e-3);
}

TEST(RadImport, CodesStandForTheirShareOfTheBounds) {
  Properties properties = in_f32();
  RadProperty& alpha = properties[1];
  alpha = {"alpha", "r8", {std::byte{51}, std::byte{204}}, 0.0f, 2.0f};
  RadProperty& scales = properties[3];
  scales = {"scales", "ln_0r8", {}, -3.0f, 5.0f};
  for (const int code : {0, 1, 255, 128, 2, 3})
    scales.plain.push_back(static_cast<std::byte>(code));
  const GaussianCloud cloud = import_rad(one_chunk(properties, 2));
  EXPECT_NEAR(cloud.opacity[0], std::log(0.4 / 0.6), 1e-6);
  EXPECT_EQ(cloud.opacity[1], kMaxLogit);  // 1.6
  EXPECT_LT(cloud.log_scale[0], -20);      // code 0
  EXPECT_EQ(cloud.log_scale[3], -3.0f);
  EXPECT_EQ(cloud.log_scale[1], 5.0f);
  EXPECT_NEAR(cloud.log_scale[4], -3 + 8.0 * 127 / 254, 1e-6);
}

// The axis (x, y, z) on an octahedron whose lower half is folded outwards.
TEST(RadImport, RotationsInThreeBytesAreAnAxisAndAnAngle) {
  const GaussianCloud whole = sample(500, 0);
  const GaussianCloud read = import_rad(rad_of(whole, 65536));
  for (size_t i = 0; i < 500; ++i) {
    double dot = 0;
    for (size_t k = 0; k < 4; ++k)
      dot += double{whole.rotation[4 * i + k]} * double{read.rotation[4 * i + k]};
    EXPECT_GT(std::fabs(dot), 1 - 2e-4) << i;
  }
  const std::array<float, 4> turned = rotation_of_oct88r8(255, 128, 255);
  EXPECT_NEAR(turned[0], 0, 1e-6);  // half a turn
  EXPECT_NEAR(turned[1], 1, 0.01);  // about x
}

// As Spark writes by default, within half of its steps.
TEST(RadImport, ShAndColoursKeepTheirPlaces) {
  for (int degree = 0; degree <= 3; ++degree) {
    const GaussianCloud cloud = sample(40, degree), read = import_rad(rad_of(cloud, 16));
    ASSERT_EQ(read.sh_degree, degree);
    ASSERT_EQ(read.size(), 40u);
    EXPECT_EQ(read.position, cloud.position);
    const size_t width = static_cast<size_t>(cloud.coefficients()) * 3;
    for (size_t i = 0; i < cloud.sh.size(); ++i)
      EXPECT_NEAR(read.sh[i], cloud.sh[i], i % width < 3 ? 0.501 * 3 / 255 / 0.282 : 0.501 / 127);
    for (size_t i = 0; i < 120; ++i)
      EXPECT_NEAR(read.log_scale[i], cloud.log_scale[i], 0.501 * 21 / 254);
  }
}

TEST(RadImport, DifferencesAreFromTheGaussianBeforeInTheSameChunk) {
  const GaussianCloud cloud = sample(6, 1);
  const auto of = [&](bool delta) {
    std::vector<Bytes> chunks;
    for (const size_t base : {size_t{0}, size_t{4}}) {
      const size_t count = base == 0 ? 4 : 2;
      Properties properties = rad_properties(cloud, base, count);
      if (delta) properties[5] = rad_delta(properties[5], count);
      chunks.push_back(rad_chunk(base, count, properties));
    }
    return import_rad(rad_file(rad_meta(6, 1, 4, false), chunks));
  };
  EXPECT_EQ(of(true).sh, of(false).sh);
}

Bytes tree(const std::vector<uint16_t>& children, size_t chunk_size) {
  const GaussianCloud cloud = sample(children.size(), 1);
  std::vector<Bytes> chunks;
  for (size_t base = 0; base < children.size(); base += chunk_size) {
    const size_t count = std::min(chunk_size, children.size() - base);
    Properties properties = rad_properties(cloud, base, count);
    const auto* first = children.data() + base;
    properties.push_back(rad_children({first, first + count}));
    properties.push_back(rad_child_starts(std::vector<uint32_t>(count, 1)));
    chunks.push_back(rad_chunk(base, count, properties));
  }
  return rad_file(rad_meta(children.size(), 1, chunk_size, true), chunks);
}

TEST(RadImport, OfATreeTheNodesWithoutChildren) {
  const GaussianCloud cloud = sample(7, 1);
  for (const size_t chunk_size : {7, 2, 3}) {  // of 2: the first chunk has no leaves
    const GaussianCloud leaves = import_rad(tree({2, 3, 0, 0, 1, 0, 0}, chunk_size));
    ASSERT_EQ(leaves.size(), 4u);
    size_t at = 0;
    for (const size_t leaf : {2, 3, 5, 6}) {
      EXPECT_EQ(leaves.position[3 * at], cloud.position[3 * leaf]) << leaf;
      EXPECT_NEAR(leaves.sh[12 * at + 11], cloud.sh[12 * leaf + 11], 0.004) << leaf;
      ++at;
    }
  }
  expect_refusal(tree({2, 1, 1}, 8), "a tree that has leaves");
}

TEST(RadImport, BlocksHaveTheWordsOfTheWhole) {
  const Bytes bytes = rad_of(sample(100, 2), 40);
  const GaussianCloud whole = import_rad(bytes);
  const auto blocks = open_blocks(std::make_shared<MemorySource>("a.rad", bytes));
  EXPECT_EQ(blocks->count(), 100u);
  std::pmr::vector<float> x;
  for (RawBlock block = blocks->next(7); block.count > 0; block = blocks->next(7)) {
    EXPECT_LE(block.count, 7u);
    const GaussianCloud part = blocks->decode(block);
    x.insert(x.end(), part.position.begin(), part.position.end());
  }
  EXPECT_EQ(x, whole.position);
}

TEST(RadImport, ChunksMayBeFilesBesideIt) {
  const GaussianCloud cloud = sample(5, 0);
  fuzz::FileOfFolder::Folder files;
  Json meta = rad_meta(5, 0, 3, false);
  for (const size_t base : {size_t{0}, size_t{3}}) {
    const std::string name = "s-" + std::to_string(base / 3) + ".radc";
    files[name] = rad_chunk(base, std::min<size_t>(3, 5 - base),
                            rad_properties(cloud, base, std::min<size_t>(3, 5 - base)));
    meta["chunks"].push_back({{"offset", 0}, {"bytes", files[name].size()}, {"filename", name}});
  }
  files["s.rad"] = rad_opening("RAD0", meta);
  const auto open = [&] {
    const auto folder = std::make_shared<fuzz::FileOfFolder::Folder>(files);
    return std::make_shared<fuzz::FileOfFolder>(folder, "s.rad", folder->at("s.rad"));
  };
  EXPECT_EQ(import_gaussians(open()).position, cloud.position);
  files["s-1.radc"].resize(100);
  const std::string cut = refusal_of([&] { import_gaussians(open()); });
  EXPECT_NE(cut.find("s-1.radc: offset 0: chunk: found 100 bytes"), std::string::npos) << cut;
  files["s-1.radc"] = files["s-0.radc"];
  meta["chunks"][1]["bytes"] = files["s-0.radc"].size();
  files["s.rad"] = rad_opening("RAD0", meta);
  const std::string twice = refusal_of([&] { import_gaussians(open()); });
  EXPECT_NE(twice.find("base: found 0, expected a whole number from 3 to 3"), std::string::npos)
      << twice;
  files.erase("s-1.radc");
  EXPECT_THROW(import_gaussians(open()), Error);
}

TEST(RadImport, WhatIsNotReadIsRefusedByName) {
  const auto with = [](size_t at, const RadProperty& property) {
    Properties properties = in_f32();
    if (at == properties.size()) properties.emplace_back();
    properties[at] = property;
    return one_chunk(properties, 2);
  };
  expect_refusal(with(5, {"sh_label", "u16", Bytes(4), {}, {}}),
                 "properties[5].property: found \"sh_label\", expected SH bands for each Gaussian");
  expect_refusal(with(5, {"sh1_code", "s8", Bytes(18), {}, {}}), "tables of SH");
  expect_refusal(with(5, {"spin", "u16", Bytes(4), {}, {}}), "found \"spin\", expected a property");
  expect_refusal(with(5, rad_f32("sh1", {9, std::vector<float>(18)})),
                 "maxSh and lodTree leave out");
  expect_refusal(with(5, rad_children({0, 0})), "maxSh and lodTree leave out");
  expect_refusal(with(4, rad_f32("alpha", kAlphas)), "expected each property once");
  expect_refusal(with(1, {"alpha", "s8", Bytes(2), {}, 1.0f}),
                 "expected an encoding of alpha: f32, f16, r8");
  expect_refusal(with(1, {"alpha", "r8", Bytes(2), {}, 1.0f}), "found no field min");
  expect_refusal(with(1, {"alpha", "f32", Bytes(7), {}, {}}), "raw deflate of 8 bytes");
  expect_refusal(with(1, {"alpha", "f32", Bytes(9), {}, {}}), "raw deflate of 8 bytes");
  expect_refusal(with(1, {"alpha", "f32", Bytes(9), {}, {}, false}),
                 "found 9 bytes, expected 8 bytes");
  expect_refusal(one_chunk({}, 2), "found no property center");
}

TEST(RadImport, OtherCompressionIsRefusedByName) {
  Bytes bytes = one_chunk(in_f32(), 2);
  const Bytes gz = bytes_of("\"gz\""), xz = bytes_of("\"xz\"");
  const auto at = std::search(bytes.begin(), bytes.end(), gz.begin(), gz.end());
  ASSERT_NE(at, bytes.end());
  std::copy(xz.begin(), xz.end(), at);
  expect_refusal(bytes, "properties[0].compression: found \"xz\", expected \"gz\" (raw deflate)");
}

TEST(RadImport, HeadersThatDoNotFitAreRefused) {
  const Bytes chunk = rad_chunk(0, 2, in_f32());
  const auto with = [&](const char* field, const Json& value) {
    Json meta = rad_meta(2, 0, 65536, false);
    meta[field] = value;
    return rad_file(meta, {chunk});
  };
  expect_refusal(with("version", 2), "version: found 2");
  expect_refusal(with("type", "mesh"), "type: found \"mesh\"");
  expect_refusal(with("count", 3), "count: found 2, expected a whole number from 3 to 3");
  expect_refusal(with("count", 0), "count: found 0");
  expect_refusal(with("count", 70000), "expected 2 of 65536 Gaussians each");
  expect_refusal(with("chunkSize", 1 << 20), "chunkSize: found 1048576");
  expect_refusal(with("chunkSize", 0), "chunkSize: found 0");
  expect_refusal(with("maxSh", 4), "maxSh: found 4");
  expect_refusal(with("maxSh", 1), "found no property sh1");
  expect_refusal(with("lodTree", true), "found no property child_count");
  Json meta = rad_meta(4, 0, 2, false);
  meta["chunks"] = Json::array();
  for (int i = 0; i < 2; ++i) meta["chunks"].push_back({{"offset", 0}, {"bytes", chunk.size()}});
  Bytes twice = rad_opening("RAD0", meta);
  twice.insert(twice.end(), chunk.begin(), chunk.end());
  expect_refusal(twice, "chunks[1]: found");
}

// 100,000 Gaussians of zeros in a chunk of a few bytes.
TEST(RadImport, GaussiansThatTheBytesCannotHoldAreRefused) {
  Properties properties = in_f32();
  for (RadProperty& property : properties) property.is_deflated = false;
  Json meta = rad_meta(100'000, 0, 131072, false);
  expect_refusal(rad_file(meta, {rad_chunk(0, 100'000, properties)}), "expected 1200000 bytes");
  for (RadProperty& property : properties) property.is_deflated = true;
  expect_refusal(rad_file(meta, {rad_chunk(0, 100'000, properties)}),
                 "expected what decompresses to 1200000 bytes");
}

TEST(RadImport, EveryTruncationAndFlipIsACloudOrARefusal) {
  const Bytes whole = tree({2, 3, 0, 0, 1, 0, 0}, 4);
  for (size_t size = 4; size < whole.size(); ++size)
    EXPECT_NE(refusal_of([&] {
                import_rad({whole.begin(), whole.begin() + static_cast<long>(size)});
              }),
              "")
        << size;
  Bytes plain = one_chunk(in_f32(), 2);
  for (const Bytes& bytes : {whole, plain}) {
    const size_t most = 8;
    for (size_t at = 4; at < bytes.size(); ++at)
      for (const int flip : {1, 0x20, 0xff}) {
        Bytes flipped = bytes;
        flipped[at] ^= static_cast<std::byte>(flip);
        try {
          EXPECT_LE(import_rad(flipped).size(), most);
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ErrorCode::refused_input) << error.what();
        }
      }
  }
}

}  // namespace
}  // namespace voyager::rad_import_test
