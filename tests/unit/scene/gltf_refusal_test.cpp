// No .glb or .gltf may crash, hang or take what it does not hold.
#include "runtime/scene/import/block_reader.h"
#include "tests/support/gltf_files.h"
#include "tests/support/test_support.h"

namespace voyager::gltf_refusal_test {
namespace {

using test::Bytes;
using test::GltfFile;
using test::Json;
using test::khr;

constexpr const char* kExtension = "KHR_gaussian_splatting";

// Two nodes, one below the other, a mesh of two primitives.
GltfFile small_file() {
  GltfFile file;
  const Json primitives = Json::array({file.primitive_of(test::random_cloud(3, 1, 1)),
                                       file.primitive_of(test::random_cloud(2, 2, 0))});
  const int root =
      static_cast<int>(file.add_node({{"translation", {1, 2, 3}}, {"scale", {2, 2, 2}}}));
  file.add_node({{"mesh", file.add_mesh(primitives)}, {"rotation", {0, 0, 1, 0}}}, root);
  return file;
}

// A cloud of at most so many Gaussians, or a refusal.
void expect_bounded(const Bytes& bytes, size_t most, const std::string& what) {
  try {
    EXPECT_LE(test::import_source(bytes).size(), most) << what;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::refused_input) << what << ": " << error.what();
  }
}

std::string refusal(const Bytes& bytes) {
  return test::refusal_of([&] { test::import_source(bytes); });
}

TEST(GltfRefusal, EveryTruncation) {
  const Bytes glb = small_file().glb(), gltf = small_file().gltf();
  for (const Bytes& whole : {glb, gltf})
    for (size_t size = 0; size < whole.size(); ++size) {
      const std::string message =
          refusal(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
      EXPECT_EQ(message.rfind("sample.glb: ", 0), 0u) << size << message;
      EXPECT_NE(message.find("expected "), std::string::npos) << message;
    }
  Bytes longer = glb;
  longer.push_back(std::byte{0});
  EXPECT_NE(refusal(longer).find("length"), std::string::npos);
}

TEST(GltfRefusal, NoFlippedByteCrashes) {
  for (const Bytes& whole : {small_file().glb(), small_file().gltf()})
    for (size_t at = 0; at < whole.size(); ++at) {
      Bytes bytes = whole;
      bytes[at] ^= std::byte{at % 2 == 0 ? uint8_t{1} : uint8_t{0x80}};
      expect_bounded(bytes, 1000, std::to_string(at));
    }
}

TEST(GltfRefusal, EveryFieldMissingOrAbsurd) {
  const GltfFile good = small_file();
  Json whole = good.json;
  whole["buffers"] = {{{"byteLength", good.binary.size()}}};
  test::for_bad_fields(whole, [&](const Json& bad, const std::string& what) {
    expect_bounded(GltfFile::glb_of(bad.dump(), good.binary), 10, what);
  });
}

struct Change {
  const char* at;
  Json value;
  std::string said;
};

TEST(GltfRefusal, NamesWhatItDoesNotRead) {
  const GltfFile good = small_file();
  const std::string primitive = "/meshes/0/primitives/0";
  const std::vector<Change> changes = {
      {"/extensionsRequired", {"EXT_meshopt_compression"}, "EXT_meshopt_compression"},
      {"/asset/version", "1.0", "\"2.0\""},
      {"/accessors/0/sparse", {{"count", 1}}, "sparse"},
      {"/accessors/0/count", 4, "what its bytes hold"},
      {"/accessors/0/count", 1000000000000, "what its bytes hold"},
      {"/accessors/0/count", UINT64_MAX, "what its bytes hold"},
      {"/accessors/0/byteOffset", UINT64_MAX, "byteOffset"},
      {"/accessors/0/type", "MAT4", "SCALAR, VEC2, VEC3 or VEC4"},
      {"/accessors/0/componentType", 5125, "POSITION"},
      {"/bufferViews/0/byteLength", UINT64_MAX, "a range of the buffer"},
      {"/bufferViews/0/byteOffset", UINT64_MAX, "a range of the buffer"},
      {"/bufferViews/0/byteStride", 8, "byteStride"},
      {"/bufferViews/0/byteStride", 256, "byteStride"},
      {"/bufferViews/0/buffer", 1, "an entry 1"},
      {"/nodes/0/children", {0}, "node 0 once more"},
      {"/nodes/0/children", {1, 1}, "node 1 once more"},
      {"/nodes/0/scale", {0, 1, 1}, "none that flattens"},
      {"/nodes/0/scale", {1, 1}, "3 finite numbers"},
      {"/nodes/0/rotation", {0, 0, 0, 0}, "a unit quaternion"},
      {"/nodes/0/matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "last row"},
      {"/nodes/1/extensions", {{"EXT_mesh_gpu_instancing", 1}}, "EXT_mesh_gpu_instancing"},
      {"/scenes/0/nodes", Json::array(), "no node of the scene"},
      {"/meshes/0/primitives/0/mode", 4, "0 (POINTS)"},
      {"/meshes/0/primitives/1/attributes/POSITION", 0, "3, as POSITION has"},
  };
  for (const Change& change : changes) {
    GltfFile bad = good;
    bad.json[Json::json_pointer(change.at)] = change.value;
    const std::string message = refusal(bad.glb());
    EXPECT_NE(message.find(change.said), std::string::npos) << change.at << ": " << message;
    EXPECT_EQ(message.rfind("sample.glb: ", 0), 0u) << message;
  }
  for (const char* needed : {"ROTATION", "SCALE", "OPACITY"}) {
    GltfFile bad = good;
    bad.json["meshes"][0]["primitives"][0]["attributes"].erase(khr(needed));
    EXPECT_NE(refusal(bad.glb()).find(needed), std::string::npos);
  }
}

TEST(GltfRefusal, AFileWithoutSplats) {
  GltfFile mesh = small_file();
  for (Json& primitive : mesh.json["meshes"][0]["primitives"]) primitive.erase("extensions");
  EXPECT_NE(refusal(mesh.glb()).find(kExtension), std::string::npos);
}

// A million nodes may share a mesh, and accessors need no bytes. The first that is too much is
// refused, and not the sum of all.
TEST(GltfRefusal, MoreGaussiansThanTheFileIsWorth) {
  GltfFile zeros = small_file();
  for (Json& accessor : zeros.json["accessors"]) {
    accessor.erase("bufferView");
    accessor["count"] = 1000000000000;
  }
  EXPECT_NE(refusal(zeros.glb()).find("Gaussians: found 1000000000000, expected at most"),
            std::string::npos);
  GltfFile shared = test::gltf_of(test::random_cloud(1000, 1, 0));
  for (int i = 0; i < 5000; ++i) shared.add_node({{"mesh", 0}});
  const std::string message = refusal(shared.glb());
  EXPECT_NE(message.find("000, expected at most "), std::string::npos) << message;
}

// Siblings without end are no reason to look at all of them again for each.
TEST(GltfRefusal, ManySiblingsAreReadAtOnce) {
  std::string many = "{\"asset\":{\"version\":\"2.0\"},\"extras\":[{}";
  for (int i = 0; i < 300000; ++i) many += ",{}";
  EXPECT_NE(refusal(test::bytes_of(many + "]}")).find("no node of the scene"), std::string::npos);
}

// A thousand nodes with a thousand primitives are a million parts, of no Gaussians each.
TEST(GltfRefusal, MorePartsThanTheFileIsWorth) {
  GltfFile file = test::gltf_of(GaussianCloud());
  Json& primitives = file.json["meshes"][0]["primitives"];
  while (primitives.size() < 1000) primitives.push_back(Json(primitives[0]));
  for (int i = 0; i < 1000; ++i) file.add_node({{"mesh", 0}});
  EXPECT_NE(refusal(file.glb()).find("placed primitives, expected at most"), std::string::npos);
}

TEST(GltfRefusal, NestingIsBounded) {
  // Nodes may be as deep as they like.
  GltfFile deep;
  const size_t mesh = deep.add_mesh(Json::array({deep.primitive_of(test::random_cloud(1, 1, 0))}));
  Json nodes = Json::array({{{"mesh", mesh}}});
  for (size_t i = 0; i < 20000; ++i) nodes.push_back({{"children", {i}}});
  deep.json["nodes"] = nodes;
  deep.json["scenes"][0]["nodes"] = {20000};
  EXPECT_EQ(test::import_source(deep.glb()).size(), 1u);
  const std::string levels = refusal(
      test::bytes_of("{\"extras\":" + std::string(100000, '[') + std::string(100000, ']') + "}"));
  EXPECT_NE(levels.find("levels"), std::string::npos) << levels;
  EXPECT_NE(refusal(test::bytes_of("{\"asset\": 1e999}")).find("JSON"), std::string::npos);
  EXPECT_NE(refusal(test::bytes_of("{\"asset\": \"\xff\"}")).find("JSON"), std::string::npos);
}

}  // namespace
}  // namespace voyager::gltf_refusal_test
