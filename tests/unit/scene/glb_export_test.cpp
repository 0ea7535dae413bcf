#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "runtime/math/sh.h"
#include "runtime/scene/gltf_format.h"
#include "tests/support/gltf_files.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::glb_export_test {
namespace {

uint32_t u32(const test::Bytes& bytes, size_t at) {
  uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// A reader of the one primitive, by glTF's specification.
struct Glb {
  explicit Glb(test::Bytes all) : bytes(std::move(all)) {
    EXPECT_EQ(u32(bytes, 0), 0x46546c67u);
    EXPECT_EQ(u32(bytes, 4), 2u);
    EXPECT_EQ(u32(bytes, 8), bytes.size());
    const size_t json_bytes = u32(bytes, 12);
    EXPECT_EQ(json_bytes % 4, 0u);
    EXPECT_EQ(u32(bytes, 16), 0x4e4f534au);
    const char* text = reinterpret_cast<const char*>(bytes.data()) + 20;
    json = nlohmann::json::parse(text, text + json_bytes);
    binary = 20 + json_bytes + 8;
    EXPECT_EQ(u32(bytes, 20 + json_bytes), bytes.size() - binary);
    EXPECT_EQ(u32(bytes, 24 + json_bytes), 0x004e4942u);
  }

  const nlohmann::json& primitive() const { return json["meshes"][0]["primitives"][0]; }
  const nlohmann::json& accessor(const std::string& semantic) const {
    return json["accessors"][primitive()["attributes"][semantic].get<size_t>()];
  }
  std::vector<float> floats(const std::string& semantic) const {
    const nlohmann::json& of = accessor(semantic);
    const nlohmann::json& view = json["bufferViews"][of["bufferView"].get<size_t>()];
    const std::string type = of["type"];
    const size_t components = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : 4;
    std::vector<float> values(of["count"].get<size_t>() * components);
    EXPECT_EQ(view["byteLength"].get<size_t>(), values.size() * sizeof(float));
    std::memcpy(values.data(), bytes.data() + binary + view["byteOffset"].get<size_t>(),
                values.size() * sizeof(float));
    return values;
  }
  std::vector<float> splat(const std::string& name) const {
    return floats("KHR_gaussian_splatting:" + name);
  }

  test::Bytes bytes;
  nlohmann::json json;
  size_t binary = 0;
};

Glb glb_of(const GaussianCloud& cloud) {
  test::PlacedBytesSink sink;
  const auto writer = write_glb(sink, cloud.size(), cloud.sh_degree);
  writer->append(cloud);
  writer->finish();
  return Glb(sink.bytes);
}

std::string sh_name(size_t k) {
  const int degree = k == 0 ? 0 : k < 4 ? 1 : k < 9 ? 2 : 3;
  return "SH_DEGREE_" + std::to_string(degree) + "_COEF_" +
         std::to_string(static_cast<int>(k) - degree * degree);
}

TEST(GlbExport, HoldsGaussiansAsTheyAreDrawn) {
  for (const int degree : {0, 1, 2, 3}) {
    const GaussianCloud cloud = test::random_cloud(50, 3, degree);
    const Glb glb = glb_of(cloud);
    const auto position = glb.floats("POSITION"), rotation = glb.splat("ROTATION"),
               scale = glb.splat("SCALE"), opacity = glb.splat("OPACITY");
    for (size_t i = 0; i < cloud.size(); ++i) {
      const Gaussian g = activate(cloud.words(i), true);
      // The rotation is followed by half a turn about z.
      const float expected[] = {-g.mean.x,    -g.mean.y,    g.mean.z,      -g.rotation.y,
                                g.rotation.x, g.rotation.w, -g.rotation.z, g.scale.x,
                                g.scale.y,    g.scale.z,    g.opacity};
      EXPECT_TRUE(std::equal(expected, expected + 3, &position[3 * i]));
      EXPECT_TRUE(std::equal(expected + 3, expected + 7, &rotation[4 * i]));
      EXPECT_TRUE(std::equal(expected + 7, expected + 10, &scale[3 * i]));
      EXPECT_EQ(expected[10], opacity[i]);
    }
    const auto coefficients = static_cast<size_t>(cloud.coefficients());
    EXPECT_EQ(glb.primitive()["attributes"].size(), 4 + coefficients);
    for (size_t k = 0; k < coefficients; ++k) {
      const std::vector<float> values = glb.splat(sh_name(k));
      for (size_t i = 0; i < values.size(); ++i)
        ASSERT_EQ(values[i], static_cast<float>(gltf::kToInria.sh[k]) *
                                 cloud.sh[(i / 3 * coefficients + k) * 3 + i % 3]);
    }
  }
}

// Not another rotation of the same ellipsoid.
TEST(GlbExport, RotationsComeBack) {
  const GaussianCloud cloud = test::random_cloud(50, 3, 0);
  const GaussianCloud back = test::import_source(glb_of(cloud).bytes);
  ASSERT_EQ(back.size(), cloud.size());
  for (size_t i = 0; i < cloud.size(); ++i) {
    const Quatf a = activate(cloud.words(i), true).rotation,
                b = activate(back.words(i), true).rotation;
    EXPECT_NEAR(std::fabs(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z), 1, 1e-6) << i;
  }
}

// Seen from a direction that is turned with the scene, colours are the same.
TEST(GlbExport, SignsOfShAreThoseOfHalfATurnAboutZ) {
  const Vec3d d{0.48, -0.6, 0.64}, turned{-d.x, -d.y, d.z};
  double here[16], there[16];
  sh_basis(3, d, here);
  sh_basis(3, turned, there);
  for (size_t k = 0; k < 16; ++k) EXPECT_NEAR(there[k], gltf::kToInria.sh[k] * here[k], 1e-12) << k;
}

TEST(GlbExport, SaysWhatASplatReaderAsks) {
  const GaussianCloud cloud = test::random_cloud(50, 3, 0);
  const Glb glb = glb_of(cloud);
  EXPECT_EQ(glb.json["extensionsUsed"], nlohmann::json::parse(R"(["KHR_gaussian_splatting"])"));
  EXPECT_EQ(glb.primitive()["mode"], 0);
  const nlohmann::json& extension = glb.primitive()["extensions"]["KHR_gaussian_splatting"];
  EXPECT_EQ(extension["kernel"], "ellipse");
  EXPECT_EQ(extension["colorSpace"], "srgb_rec709_display");
  const std::vector<float> position = glb.floats("POSITION");
  for (size_t axis = 0; axis < 3; ++axis) {
    float least = position[axis], most = position[axis];
    for (size_t i = axis; i < position.size(); i += 3) {
      least = std::min(least, position[i]);
      most = std::max(most, position[i]);
    }
    EXPECT_EQ(glb.accessor("POSITION")["min"][axis].get<float>(), least);
    EXPECT_EQ(glb.accessor("POSITION")["max"][axis].get<float>(), most);
  }
}

// So that a scene far from the world's origin keeps its precision.
TEST(GlbExport, TheOriginIsTheNodesTranslation) {
  GaussianCloud cloud = test::random_cloud(20, 3, 0);
  cloud.origin = {4404.0 * 1024, -1024.0, 17.0 * 1024};
  const Glb glb = glb_of(cloud);
  const double expected[] = {-4404.0 * 1024, 1024.0, 17.0 * 1024};
  for (size_t k = 0; k < 3; ++k)
    EXPECT_EQ(glb.json["nodes"][0]["translation"][k].get<double>(), expected[k]);
  EXPECT_EQ(glb.floats("POSITION")[2], cloud.position[2]);
}

TEST(GlbExport, BatchesMakeTheSameBytesAsOne) {
  const GaussianCloud cloud = test::random_cloud(40, 3, 1);
  GaussianCloud both = cloud;
  for (const auto words : {&GaussianCloud::position, &GaussianCloud::log_scale,
                           &GaussianCloud::rotation, &GaussianCloud::opacity, &GaussianCloud::sh})
    (both.*words).insert((both.*words).end(), (cloud.*words).begin(), (cloud.*words).end());
  test::PlacedBytesSink sink;
  const auto writer = write_glb(sink, 80, 1);
  writer->append(cloud);
  writer->append(cloud);
  writer->finish();
  EXPECT_EQ(sink.bytes, glb_of(both).bytes);
}

// The block as another program wrote it.
TEST(GlbExport, ARealBlockIsAsAnotherProgramWroteIt) {
  VOYAGER_NEEDS_SCENES(folder);
  const Glb ours = glb_of(test::import_file(folder + "/formats/block.ply"));
  const auto source = open_file_source(folder + "/formats/block.glb");
  test::Bytes bytes(source->size());
  source->read(0, bytes);
  const Glb theirs(std::move(bytes));
  EXPECT_EQ(ours.floats("POSITION"), theirs.floats("POSITION"));
  for (size_t k = 0; k < 16; ++k) EXPECT_EQ(ours.splat(sh_name(k)), theirs.splat(sh_name(k))) << k;
  for (const char* name : {"SCALE", "OPACITY", "ROTATION"}) {
    const std::vector<float> a = ours.splat(name), b = theirs.splat(name);
    const float unit = name == std::string("ROTATION") ? 1.0f : 0.0f;
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i)
      ASSERT_NEAR(a[i], b[i], 2e-7f * std::max(std::fabs(b[i]), unit)) << name;
  }
}

TEST(GlbExport, WhatGltfCannotCountIsRefusedBeforeAnythingIsWritten) {
  test::PlacedBytesSink sink;
  EXPECT_THROW(write_glb(sink, 0, 0), Error);
  EXPECT_THROW(write_glb(sink, 18'200'000, 3), Error);
  EXPECT_NO_THROW(write_glb(sink, 18'100'000, 3));
  EXPECT_THROW(write_glb(sink, uint64_t{1} << 60, 3), Error);
  EXPECT_THROW(write_glb(sink, 3, 4), Error);
  EXPECT_THROW(write_glb(sink, 2, 1)->append(test::random_cloud(3, 3, 1)), Error);
  EXPECT_TRUE(sink.bytes.empty());
}

}  // namespace
}  // namespace voyager::glb_export_test
