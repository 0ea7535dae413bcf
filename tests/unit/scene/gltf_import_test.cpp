// What a .glb or .gltf says, as INRIA's words.
#include <chrono>
#include <cstring>
#include <fstream>

#include "runtime/math/affine.h"
#include "runtime/math/half_turn.h"
#include "runtime/math/srgb.h"
#include "runtime/scene/gltf_format.h"
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/sanitise.h"
#include "runtime/scene/transform.h"
#include "tests/support/gltf_files.h"
#include "tests/support/test_support.h"
#include "tests/support/transforms.h"

namespace voyager::gltf_import_test {
namespace {

using gltf::kSpz2;
using test::Bytes;
using test::GltfFile;
using test::Json;
using test::khr;

constexpr const char* kExtension = "KHR_gaussian_splatting";

// Scales and opacities went through exp and sigmoid in binary32.
void expect_near(const GaussianCloud& found, const GaussianCloud& expected, double tolerance = 0) {
  ASSERT_EQ(found.size(), expected.size());
  ASSERT_EQ(found.sh_degree, expected.sh_degree);
  const auto near = [](const auto& a, const auto& b, double most) {
    for (size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], most) << i;
  };
  near(found.position, expected.position, tolerance);
  near(found.rotation, expected.rotation, tolerance);
  near(found.sh, expected.sh, tolerance);
  near(found.log_scale, expected.log_scale, 1e-6 + tolerance);
  near(found.opacity, expected.opacity, 1e-4);
}

void write_file(const std::string& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

TEST(GltfImport, KeepsTheNumbersOfEverySHDegree) {
  for (int degree = 0; degree <= 3; ++degree) {
    const GaussianCloud cloud = test::random_cloud(50, 3, degree);
    const GltfFile file = test::gltf_of(cloud);
    const GaussianCloud read = test::import_source(file.glb());
    expect_near(read, cloud);
    EXPECT_EQ(read.report.read, 50u);
    EXPECT_EQ(read.report.repaired() + read.report.dropped(), 0u);
    test::expect_same(test::import_source(file.gltf()), read);
    Bytes spaced = test::bytes_of(" \n\t");
    const Bytes text = file.gltf();
    spaced.insert(spaced.end(), text.begin(), text.end());
    test::expect_same(test::import_source(spaced), read);
  }
}

TEST(GltfImport, ReadsBuffersBeside) {
  const test::TempFolder folder;
  const GltfFile file = test::gltf_of(test::random_cloud(20, 4, 1));
  std::filesystem::create_directory(folder.file("sub"));
  write_file(folder.file("sub/a b.bin"), file.binary);
  write_file(folder.file("scene.gltf"), file.gltf("sub/a%20b.bin"));
  test::expect_same(test::import_file(folder.file("scene.gltf")), test::import_source(file.glb()));
}

TEST(GltfImport, ReadsNoFileElsewhere) {
  const test::TempFolder folder;
  const GltfFile file = test::gltf_of(test::random_cloud(2, 4, 0));
  std::filesystem::create_directory(folder.file("in"));
  write_file(folder.file("outside.bin"), file.binary);
  std::filesystem::create_symlink(folder.file("outside.bin"), folder.file("in/link.bin"));
  for (const std::string& uri :
       {std::string("../outside.bin"), std::string("%2e%2e/outside.bin"),
        std::string("a/../../outside.bin"), folder.file("outside.bin"), std::string("link.bin"),
        "file://" + folder.file("outside.bin"), std::string("http://127.0.0.1/outside.bin"),
        std::string("%00"), std::string("%2"), std::string(".")}) {
    write_file(folder.file("in/scene.gltf"), file.gltf(uri));
    const std::string message =
        test::refusal_of([&] { test::import_file(folder.file("in/scene.gltf")); });
    EXPECT_NE(message.find("expected"), std::string::npos) << uri << ": " << message;
  }
  // What is not a file has no folder.
  const std::string message =
      test::refusal_of([&] { test::import_source(file.gltf("outside.bin")); });
  EXPECT_NE(message.find("outside.bin, expected all data inside"), std::string::npos) << message;
}

TEST(GltfImport, IsRefusedInAStream) {
  const std::string message = test::refusal_of(
      [] { test::import_piped(test::gltf_of(test::random_cloud(2, 4, 0)).glb()); });
  EXPECT_NE(message.find("cannot be read from a stream"), std::string::npos) << message;
}

TEST(GltfImport, IntegersAreSharesOfOne) {
  GltfFile file = test::gltf_of(test::random_cloud(2, 4, 0));
  Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
  attributes[khr("ROTATION")] =
      file.add_accessor<int8_t>({0, 0, 127, 0, -128, 0, 0, 0}, "VEC4", 5120, true);
  attributes[khr("SCALE")] =
      file.add_accessor<int16_t>({32767, 16384, 1, 2, 3, 0}, "VEC3", 5122, true);
  attributes[khr("OPACITY")] = file.add_accessor<uint16_t>({65535, 16384}, "SCALAR", 5123, true);
  attributes["POSITION"] = file.add_accessor<uint8_t>({1, 2, 3, 4, 5, 255}, "VEC3", 5121);
  const GaussianCloud cloud = test::import_source(file.glb());
  EXPECT_EQ(cloud.rotation[0], 1.0f);
  EXPECT_EQ(cloud.rotation[4 + 2], 1.0f);  // -128 is -1, too
  EXPECT_EQ(cloud.log_scale[0], 0.0f);
  EXPECT_NEAR(cloud.log_scale[1], std::log(16384 / 32767.0), 1e-6);
  EXPECT_EQ(cloud.log_scale[5], kMinLogScale);
  EXPECT_EQ(cloud.opacity[0], kMaxLogit);
  EXPECT_NEAR(sigmoid(cloud.opacity[1]), 16384 / 65535.0, 1e-6);
  EXPECT_EQ(cloud.position[5], 255.0f);
  EXPECT_EQ(cloud.position[0], -1.0f);
}

TEST(GltfImport, StepsFromElementToElementAsTheViewSays) {
  const GaussianCloud cloud = test::random_cloud(9, 4, 0);
  GltfFile file = test::gltf_of(cloud);
  Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
  // Position and opacity side by side, and 4 bytes of nothing before them.
  Bytes bytes;
  for (size_t i = 0; i < cloud.size(); ++i) {
    test::put<uint32_t>(bytes, 0xffffffffu);
    for (const float v : {-cloud.position[3 * i], -cloud.position[3 * i + 1],
                          cloud.position[3 * i + 2], sigmoid(cloud.opacity[i])})
      test::put(bytes, v);
  }
  const size_t view = file.add_view(bytes, 20);
  for (const auto& [name, offset, type] :
       {std::tuple("POSITION", 4, "VEC3"), {"KHR_gaussian_splatting:OPACITY", 16, "SCALAR"}}) {
    attributes[name] = file.json["accessors"].size();
    file.json["accessors"].push_back({{"bufferView", view},
                                      {"byteOffset", offset},
                                      {"componentType", 5126},
                                      {"count", cloud.size()},
                                      {"type", type}});
  }
  expect_near(test::import_source(file.glb()), cloud);
}

TEST(GltfImport, ColoursWithoutShAreThoseOfPoints) {
  const GaussianCloud cloud = test::random_cloud(2, 4, 0);
  GltfFile file = test::gltf_of(cloud);
  Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
  attributes.erase(khr("SH_DEGREE_0_COEF_0"));
  attributes.erase(khr("OPACITY"));
  attributes["COLOR_0"] =
      file.add_accessor<uint8_t>({255, 0, 51, 128, 10, 20, 30, 255}, "VEC4", 5121, true);
  const GaussianCloud read = test::import_source(file.glb());
  const float expected[6] = {1.0f, 0.0f, 0.2f, 10 / 255.0f, 20 / 255.0f, 30 / 255.0f};
  for (size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(0.5 + kSh0 * static_cast<double>(read.sh[i]), expected[i], 1e-6);
  EXPECT_NEAR(sigmoid(read.opacity[0]), 128 / 255.0, 1e-6);
  EXPECT_EQ(read.opacity[1], kMaxLogit);
}

TEST(GltfImport, LinearColoursAreEncoded) {
  const Vec3d d = {0.48, -0.6, 0.64};
  for (const int degree : {0, 1, 3}) {
    GaussianCloud cloud = test::random_cloud(40, 4, degree);
    for (size_t i = 0; i < cloud.sh.size(); ++i) cloud.sh[i] *= i % (3 * 16) < 3 ? 0.5f : 0.05f;
    GltfFile file = test::gltf_of(cloud);
    file.json["meshes"][0]["primitives"][0]["extensions"][kExtension]["colorSpace"] =
        "lin_rec709_display";
    const GaussianCloud read = test::import_source(file.glb());
    for (size_t i = 0; i < cloud.size(); ++i) {
      const auto colour = [&](const GaussianCloud& from) {
        const float* sh = &from.sh[i * static_cast<size_t>(from.coefficients()) * 3];
        return sh_colour(from.sh_degree, d, [sh](int k, int channel) {
          return static_cast<double>(sh[3 * k + channel]);
        });
      };
      const Vec3d linear = colour(cloud), found = colour(read);
      for (int c = 0; c < 3; ++c) {
        const double off = std::fabs(found[c] - encode_srgb(linear[c]));
        EXPECT_LE(off, degree == 0 ? 1e-6 : 0.03) << linear[c];
      }
    }
  }
}

// Drafts of the extension stored logarithms, of which most are negative.
TEST(GltfImport, NegativeScalesAreLogarithms) {
  const GaussianCloud cloud = test::random_cloud(5, 4, 0);
  GltfFile file = test::gltf_of(cloud);
  file.json["meshes"][0]["primitives"][0]["attributes"][khr("SCALE")] =
      file.add_floats({cloud.log_scale.begin(), cloud.log_scale.end()}, "VEC3");
  EXPECT_EQ(test::import_source(file.glb()).log_scale, cloud.log_scale);
}

// Half a turn about z takes glTF's axes to INRIA's.
Affine inria(const Mat3d& linear, const Vec3d& offset) {
  const Mat3d half = test::diagonal(-1, -1, 1);
  return {half * linear * half, half * offset};
}

TEST(GltfImport, NodesPlaceTheirPrimitives) {
  const GaussianCloud cloud = test::random_cloud(30, 4, 3);
  const double s = std::sqrt(0.5);
  GltfFile file;
  const size_t mesh = file.add_mesh(Json::array({file.primitive_of(cloud)}));
  const int root = static_cast<int>(file.add_node(
      {{"translation", {1, 2, 3}}, {"rotation", {0, s, 0, s}}, {"scale", {2, 2, 2}}}));
  file.add_node({{"mesh", mesh}, {"scale", {-1, 1, 1}}, {"translation", {0, 0, 5}}}, root);
  file.add_node({{"mesh", mesh}, {"matrix", {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1}}});
  const GaussianCloud read = test::import_source(file.glb());
  const Affine upper = inria(test::times(2, test::turn(s, 0, s, 0)), {1, 2, 3});
  const Affine lower = inria(test::diagonal(-1, 1, 1), {0, 0, 5});
  GaussianCloud first = cloud, second = cloud;
  CloudTransform(upper * lower, "").apply(first, {0, 0, 0});
  CloudTransform(inria(test::diagonal(1, 2, 1), {7, 8, 9}), "").apply(second, {0, 0, 0});
  ASSERT_EQ(read.size(), 60u);
  for (const auto& [part, at] : {std::pair(&first, size_t{0}), {&second, size_t{30}}})
    for (size_t i = 0; i < 30; ++i) {
      const GaussianWords a = read.words(at + i), b = part->words(i);
      const Quatf p = normalise(a.rotation), q = normalise(b.rotation);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(a.mean[axis], b.mean[axis], 1e-5);
        EXPECT_NEAR(a.log_scale[axis], b.log_scale[axis], 1e-5);
      }
      EXPECT_NEAR(std::fabs(p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z), 1, 1e-4);
      for (size_t k = 0; k < 48; ++k)
        EXPECT_NEAR(read.sh[(at + i) * 48 + k], part->sh[i * 48 + k], 1e-5);
    }
}

TEST(GltfImport, PrimitivesOfSeveralDegreesBecomeOneCloud) {
  const GaussianCloud low = test::random_cloud(3, 1, 1), high = test::random_cloud(4, 2, 3);
  GltfFile file;
  file.add_node(
      {{"mesh", file.add_mesh(Json::array({file.primitive_of(low), file.primitive_of(high)}))}});
  const GaussianCloud read = test::import_source(file.glb());
  ASSERT_EQ(read.size(), 7u);
  ASSERT_EQ(read.sh_degree, 3);
  EXPECT_EQ(read.sh[12], 0.0f);
  EXPECT_EQ(read.sh[0], low.sh[0]);
  EXPECT_EQ(read.sh[3 * 48], high.sh[0]);
}

TEST(GltfImport, FarNodesHaveAnOrigin) {
  const GaussianCloud cloud = test::random_cloud(3, 1, 0);
  const GltfFile file = test::gltf_of(cloud, {{"translation", {1e7, 0, -5}}});
  const GaussianCloud read = test::import_source(file.glb());
  EXPECT_EQ(read.origin[0], -std::round(1e7 / 1024) * 1024);
  EXPECT_NEAR(read.origin[0] + double{read.position[0]}, -1e7 + double{cloud.position[0]}, 1e-4);
}

// `primitives` of one SPZ; without bounds of POSITION.
GltfFile spz_file(const Bytes& spz, size_t count, const std::string& name, size_t primitives = 1) {
  GltfFile file;
  const Json primitive = {
      {"attributes", {{"POSITION", 0}}},
      {"mode", 0},
      {"extensions",
       {{kExtension, {{"extensions", {{name, {{"bufferView", file.add_view(spz)}}}}}}}}}};
  file.json["accessors"].push_back({{"componentType", 5126}, {"count", count}, {"type", "VEC3"}});
  file.json["extensionsRequired"] = {kExtension, name};
  file.add_node({{"mesh", file.add_mesh(Json(primitives, primitive))}});
  return file;
}
GltfFile spz_file(const GaussianCloud& cloud, const std::string& name = kSpz2) {
  return spz_file(test::spz_v4(cloud), cloud.size(), name);
}

// Of the .spz alone, whose numbers are taken to be in the axes right, up, back: as a turn about
// `axis` of them leaves them.
GaussianCloud turned(GaussianCloud cloud, const HalfTurn& turn) {
  const auto width = static_cast<size_t>(cloud.coefficients()) * 3;
  for (size_t i = 0; i < cloud.position.size(); ++i)
    cloud.position[i] = turn.turned(cloud.position[i], i % 3);
  for (size_t i = 0; i < cloud.rotation.size(); ++i)
    if (i % 4 != 0) cloud.rotation[i] = turn.turned(cloud.rotation[i], i % 4 - 1);
  for (size_t i = 0; i < cloud.sh.size(); ++i) cloud.sh[i] *= float(turn.sh[i % width / 3]);
  return cloud;
}

// CesiumJS takes them so, whatever the draft says of the axes of a .spz.
TEST(GltfImport, NumbersOfASpzInsideAreInGltfsAxes) {
  const GaussianCloud cloud = test::random_cloud(70, 1, 3);
  const GaussianCloud alone = test::import_bytes(test::spz_v4(cloud));
  for (const char* name : {"KHR_gaussian_splatting_compression_spz", kSpz2})
    test::expect_same(test::import_source(spz_file(cloud, name).glb()), turned(alone, kHalfTurnY));
  GltfFile wrong = spz_file(cloud);
  wrong.json["accessors"][0]["count"] = 71;
  const std::string message = test::refusal_of([&] { test::import_source(wrong.glb()); });
  EXPECT_NE(message.find("found 71 elements, expected 70"), std::string::npos) << message;
}

// The bounds of POSITION, in glTF's axes, tell what the numbers are. glTF's are half a turn about
// y from right, up, back, and half a turn about z from a .ply's.
TEST(GltfImport, BoundsTellTheAxesOfASpzInside) {
  GaussianCloud cloud = test::random_cloud(70, 1, 3);
  for (size_t i = 0; i < cloud.position.size(); ++i)  // in one octant: no two turns look alike
    cloud.position[i] = std::fabs(cloud.position[i]) + 1;
  const GaussianCloud alone = test::import_bytes(test::spz_v4(cloud));
  // Of the numbers of the file.
  float least[3] = {1e9f, 1e9f, 1e9f}, most[3] = {-1e9f, -1e9f, -1e9f};
  for (size_t i = 0; i < alone.position.size(); ++i) {
    const float number = kHalfTurnX.turned(alone.position[i], i % 3);
    least[i % 3] = std::min(least[i % 3], number);
    most[i % 3] = std::max(most[i % 3], number);
  }
  const auto with_bounds = [&](const HalfTurn& to_gltf, float off) {
    GltfFile file = spz_file(cloud);
    for (size_t k = 0; k < 3; ++k) {
      const bool kept = to_gltf.sign[k] > 0;
      file.json["accessors"][0]["min"].push_back((kept ? least[k] : -most[k]) - off);
      file.json["accessors"][0]["max"].push_back((kept ? most[k] : -least[k]) + off);
    }
    return test::import_source(file.glb());
  };
  for (const float off : {0.0f, 0.0004f}) {  // before the numbers were rounded
    test::expect_same(with_bounds(kNoTurn, off), turned(alone, kHalfTurnY));
    test::expect_same(with_bounds(kHalfTurnY, off), alone);
    test::expect_same(with_bounds(kHalfTurnZ, off), turned(alone, kHalfTurnX));
  }
  // Bounds that are no turn's.
  test::expect_same(with_bounds(kHalfTurnX, 0), turned(alone, kHalfTurnY));
  test::expect_same(with_bounds(kHalfTurnY, 1), turned(alone, kHalfTurnY));
}

TEST(GltfImport, ASpzInsideThatSaysItsAxesIsBelieved) {
  Bytes planar = test::planar_spz(3, 4, 1, 2), named = planar;
  for (const uint32_t word : {0xadbe0003u, 4u, 4u}) test::put(named, word);  // right, up, back
  test::expect_same(test::import_source(spz_file(test::gzip(named), 4, kSpz2).glb()),
                    test::import_bytes(named));
  test::expect_same(test::import_source(spz_file(test::gzip(planar), 4, kSpz2).glb()),
                    turned(test::import_bytes(planar), kHalfTurnY));
}

// 5,000 primitives of one SPZ of 60,000 Gaussians, a file of 400 kB: it is decompressed once, and
// refused as soon as there are more than the file is worth.
TEST(GltfImport, ManyPrimitivesOfOneSpzAreBounded) {
  const GaussianCloud few = test::random_cloud(10, 1, 1);
  const GltfFile small = spz_file(test::spz_v4(few), few.size(), kSpz2, 500);
  EXPECT_EQ(test::import_source(small.glb()).size(), 5000u);
  Bytes plain = test::planar_spz(3, 0, 3);
  const uint32_t count = 60'000;
  std::memcpy(plain.data() + 8, &count, sizeof count);
  plain.resize(plain.size() + size_t{65} * count);
  const Bytes glb = spz_file(test::gzip(plain), count, kSpz2, 5000).glb();
  const auto start = std::chrono::steady_clock::now();
  const std::string message = test::refusal_of([&] { test::import_source(glb); });
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_NE(message.find("Gaussians: found "), std::string::npos) << message;
  EXPECT_LT(seconds.count(), 1.0);
  // Views that differ in length alone would be opened one by one.
  GltfFile nested = spz_file(test::spz_v4(few), few.size(), kSpz2, 2);
  Json longer = nested.json["bufferViews"][0];
  longer["byteLength"] = longer["byteLength"].get<int>() - 1;
  nested.json["bufferViews"].push_back(longer);
  nested.json["meshes"][0]["primitives"][1]["extensions"][kExtension]["extensions"][kSpz2]
             ["bufferView"] = 1;
  EXPECT_NE(test::refusal_of([&] {
              test::import_source(nested.glb());
            }).find("as another view of the same SPZ has"),
            std::string::npos);
}

TEST(GltfImport, WhatOfASpzInsideIsNotReadIsToldOnce) {
  Bytes planar = test::planar_spz(3, 3, 1, 2);
  for (const uint32_t word : {0x4e410001u, 0u}) test::put(planar, word);
  const std::string said = "an unknown extension 0x4e410001 (0 bytes), of ";
  GltfFile file = spz_file(planar, 3, kSpz2, 7);
  const auto left_out = [](const GltfFile& of) {
    return left_out_of(MemorySource("sample.glb", of.glb()));
  };
  EXPECT_EQ(left_out(file), std::vector<std::string>{said + "the SPZ inside"});
  const size_t more[] = {file.add_view(planar), file.add_view(test::planar_spz(3, 3, 1))};
  Json& primitives = file.json["meshes"][0]["primitives"];
  for (size_t i = 0; i < 2; ++i)
    primitives[i]["extensions"][kExtension]["extensions"][kSpz2]["bufferView"] = more[i];
  EXPECT_EQ(left_out(file), std::vector<std::string>{said + "2 of the 3 SPZ inside"});
  EXPECT_TRUE(left_out(spz_file(test::random_cloud(3, 1, 1))).empty());
}

TEST(GltfImport, BlocksOfAnySizeGiveTheSameWords) {
  GltfFile file = spz_file(test::random_cloud(70, 1, 3));
  file.add_node(
      {{"mesh", file.add_mesh(Json::array({file.primitive_of(test::random_cloud(90, 2, 1))}))},
       {"scale", {1, -2, 2}}});
  const Bytes bytes = file.glb();
  const auto source = std::make_shared<MemorySource>("sample.glb", bytes);
  const GaussianCloud whole = test::import_source(bytes);
  for (const size_t most : {size_t{1}, size_t{37}, size_t{5000}}) {
    const auto reader = open_blocks(source);
    EXPECT_EQ(reader->count(), 160u);
    std::vector<float> position, sh;
    for (;;) {
      const RawBlock block = reader->next(most);
      if (block.count == 0) break;
      EXPECT_LE(block.count, most);
      const GaussianCloud cloud = reader->decode(block);
      position.insert(position.end(), cloud.position.begin(), cloud.position.end());
      sh.insert(sh.end(), cloud.sh.begin(), cloud.sh.end());
    }
    EXPECT_TRUE(
        std::equal(position.begin(), position.end(), whole.position.begin(), whole.position.end()));
    EXPECT_TRUE(std::equal(sh.begin(), sh.end(), whole.sh.begin(), whole.sh.end()));
  }
}

}  // namespace
}  // namespace voyager::gltf_import_test
