// A .glb with SPZ inside.
#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "runtime/scene/export/flat_file.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::glb_spz_export_test {
namespace {

using test::Bytes;

Bytes glb_of(const GaussianCloud& cloud, int version = 3) {
  test::PlacedBytesSink sink;
  const auto writer = write_spz_glb(sink, cloud.size(), cloud.sh_degree, 100, version);
  writer->append(cloud);
  writer->finish();
  return sink.bytes;
}

Bytes spz_of(const GaussianCloud& cloud, int version = 3) {
  test::BytesSink sink;
  const auto writer = write_spz(sink, cloud.size(), cloud.sh_degree, 100, version);
  writer->append(cloud);
  writer->finish();
  return sink.bytes;
}

GaussianCloud import(const Bytes& bytes) {
  return import_gaussians(std::make_shared<MemorySource>("sample", bytes));
}

void expect_same(const GaussianCloud& a, const GaussianCloud& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a.sh_degree, b.sh_degree);
  EXPECT_EQ(a.native, b.native);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.log_scale, b.log_scale);
  for (size_t i = 0; i < a.rotation.size(); ++i) {  // q and -q are one rotation
    const size_t w = i / 4 * 4;
    const float sign = a.rotation[w] * b.rotation[w] < 0 ? -1.0f : 1.0f;
    EXPECT_EQ(a.rotation[i], sign * b.rotation[i]) << i;
  }
  EXPECT_EQ(a.opacity, b.opacity);
  EXPECT_EQ(a.sh, b.sh);
}

nlohmann::json json_of(const Bytes& glb) {
  uint32_t size = 0;
  std::memcpy(&size, glb.data() + 12, sizeof size);
  const char* text = reinterpret_cast<const char*>(glb.data()) + 20;
  return nlohmann::json::parse(text, text + size);
}

TEST(GlbSpzExport, ComesBackAsTheSpzAlone) {
  for (const int degree : {0, 1, 2, 3})
    for (const int version : {3, 4}) {
      GaussianCloud cloud = test::random_cloud(70, 5, degree);
      if (degree == 2) cloud.native = compensated_scale(kLowPass);
      expect_same(import(glb_of(cloud, version)), import(spz_of(cloud, version)));
    }
}

// The node is at the origin: far from the world's, positions keep their steps.
TEST(GlbSpzExport, AnOriginIsTheNodes) {
  GaussianCloud cloud = test::random_cloud(30, 6, 1);
  const GaussianCloud near = import(spz_of(cloud));
  cloud.origin = {1024.0 * 5000, -1024.0 * 30, 1024};
  const GaussianCloud far = import(glb_of(cloud));
  ASSERT_EQ(far.size(), near.size());
  for (size_t i = 0; i < far.position.size(); ++i)
    EXPECT_EQ(far.origin[i % 3] + double{far.position[i]},
              cloud.origin[i % 3] + double{near.position[i]});
}

TEST(GlbSpzExport, SaysWhatTheDraftAsksFor) {
  const GaussianCloud cloud = test::random_cloud(40, 7, 2);
  const Bytes glb = glb_of(cloud);
  const nlohmann::json json = json_of(glb);
  const std::string name = "KHR_gaussian_splatting_compression_spz_2";
  for (const char* list : {"extensionsUsed", "extensionsRequired"})
    EXPECT_EQ(json[list], (nlohmann::json{"KHR_gaussian_splatting", name}));
  const nlohmann::json& primitive = json["meshes"][0]["primitives"][0];
  EXPECT_EQ(primitive["extensions"]["KHR_gaussian_splatting"]["extensions"][name]["bufferView"], 0);
  EXPECT_EQ(primitive["attributes"].size(), 2u + 2u + 3u + 5u);
  for (const nlohmann::json& accessor : json["accessors"]) {
    EXPECT_EQ(accessor["count"], 40);
    EXPECT_FALSE(accessor.contains("bufferView"));
  }
  EXPECT_EQ(glb.size() % 4, 0u);
  const uint64_t bytes = json["bufferViews"][0]["byteLength"];
  EXPECT_EQ(bytes, spz_of(cloud).size());
  EXPECT_EQ(json["buffers"][0]["byteLength"], bytes);
}

TEST(GlbSpzExport, BoundsAreThoseOfTheDecodedPositions) {
  const GaussianCloud cloud = test::random_cloud(40, 8, 0);
  const Bytes glb = glb_of(cloud);
  const GaussianCloud back = import(glb);
  const nlohmann::json position = json_of(glb)["accessors"][0];
  for (size_t axis = 0; axis < 3; ++axis) {
    float least = INFINITY, most = -INFINITY;
    for (size_t i = 0; i < back.size(); ++i) {
      const float at = back.position[3 * i + axis] * (axis == 2 ? 1.0f : -1.0f);
      least = std::min(least, at);
      most = std::max(most, at);
    }
    EXPECT_EQ(position["min"][axis].get<float>(), least);
    EXPECT_EQ(position["max"][axis].get<float>(), most);
  }
}

// The numbers of the file are those that bounds of POSITION are of: CesiumJS turns no axes. It
// takes the matrix of the first node, and its first buffer view.
TEST(GlbSpzExport, IsWhatCesiumTakes) {
  GaussianCloud cloud = test::random_cloud(40, 8, 1);
  cloud.origin = {1024, -2048, 512};
  const Bytes glb = glb_of(cloud);
  const nlohmann::json json = json_of(glb);
  EXPECT_EQ(json["nodes"][0]["matrix"],
            (nlohmann::json{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1024, 2048, 512, 1}));
  const auto begin = glb.end() - json["buffers"][0]["byteLength"].get<std::ptrdiff_t>() -
                     (4 - json["buffers"][0]["byteLength"].get<int>() % 4) % 4;
  ASSERT_EQ(json["bufferViews"].size(), 1u);
  const GaussianCloud raw = import_gaussians(std::make_shared<MemorySource>(
      "inside.spz", std::span(begin, begin + json["bufferViews"][0]["byteLength"].get<int>())));
  for (size_t i = 0; i < cloud.position.size(); ++i) {
    // As a .spz alone it is read as right, up, back: half a turn about x from INRIA's.
    const float number = raw.position[i] * (i % 3 == 0 ? 1.0f : -1.0f);
    EXPECT_NEAR(number, cloud.position[i] * (i % 3 == 2 ? 1.0f : -1.0f), 1.0 / 4096) << i;
  }
}

// As many bits after the point as a small scene has a use for.
TEST(GlbSpzExport, StepsFollowTheSizeOfTheScene) {
  EXPECT_EQ(spz_fractional_bits_inside(3000), 11);
  EXPECT_EQ(spz_fractional_bits_inside(2000), 12);
  EXPECT_EQ(spz_fractional_bits_inside(32), 12);
  EXPECT_EQ(spz_fractional_bits_inside(1), 17);
  EXPECT_EQ(spz_fractional_bits_inside(0), 20);
  const GaussianCloud cloud = test::random_cloud(40, 8, 0, 0.5f);
  test::PlacedBytesSink sink;
  const auto writer = write_spz_glb(sink, cloud.size(), 0, 0.5f, 3);
  writer->append(cloud);
  writer->finish();
  const GaussianCloud read = import(sink.bytes);
  for (size_t i = 0; i < cloud.position.size(); ++i)
    EXPECT_NEAR(read.position[i], cloud.position[i], 0.51 / (1 << 18)) << i;
}

TEST(GlbSpzExport, IsWrittenUnderItsName) {
  const test::TempFolder folder;
  const GaussianCloud cloud = test::random_cloud(20, 9, 3);
  FlatContents contents;
  contents.sh_degree = 3;
  contents.add(cloud);
  FlatOptions options;
  options.spz_inside = true;
  options.spz_version = 3;
  write_flat_file(folder.file("a.glb"), options, contents,
                  [&](GaussianWriter& writer) { writer.append(cloud); });
  const GaussianCloud read = test::import_file(folder.file("a.glb"));
  ASSERT_EQ(read.size(), cloud.size());
  EXPECT_THROW(glb_of(test::random_cloud(0, 1, 0)), Error);
}

}  // namespace
}  // namespace voyager::glb_spz_export_test
