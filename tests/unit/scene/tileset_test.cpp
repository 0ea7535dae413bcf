// 3D Tiles whose tiles are glTF files with splats.
#include <filesystem>
#include <fstream>
#include <map>

#include "runtime/scene/gltf_format.h"
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/importer.h"
#include "runtime/scene/transform.h"
#include "tests/support/gltf_files.h"
#include "tests/support/test_support.h"

namespace voyager::tileset_test {
namespace {

using test::Bytes;
using test::Json;

class Tileset : public ::testing::Test {
 protected:
  void write(const std::string& name, const Bytes& bytes) {
    std::filesystem::create_directories(std::filesystem::path(folder.file(name)).parent_path());
    std::ofstream(folder.file(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  void write(const std::string& name, const Json& json) {
    write(name, test::bytes_of(json.dump()));
  }

  static Json tiles(Json root) {
    return {{"asset", {{"version", "1.1"}}}, {"geometricError", 10}, {"root", std::move(root)}};
  }
  static Json leaf(const std::string& uri) { return {{"content", {{"uri", uri}}}}; }

  GaussianCloud read(const Json& root) {
    write("tileset.json", tiles(root));
    return test::import_file(folder.file("tileset.json"));
  }
  std::string refusal(const Json& root) {
    return test::refusal_of([&] { read(root); });
  }

  test::TempFolder folder;
  const GaussianCloud one = test::random_cloud(20, 1, 2), two = test::random_cloud(30, 2, 1);
};

TEST_F(Tileset, ATileThatIsNotMovedIsItsFile) {
  const Bytes glb = test::gltf_of(one, {{"translation", {1, 2, 3}}}).glb();
  write("a.glb", glb);
  test::expect_same(read(leaf("a.glb")), test::import_source(glb));
  // Also with the file inside.
  test::expect_same(test::import_source(test::bytes_of(
                        tiles(leaf("data:model/gltf-binary;base64," + test::base64(glb))).dump())),
                    test::import_source(glb));
}

TEST_F(Tileset, LeavesAloneAreReadUnlessChildrenAdd) {
  write("tiles/a.glb", test::gltf_of(one).glb());
  write("tiles/b.gltf", test::gltf_of(two).gltf());
  Json root = leaf("tiles/a.glb");
  root["children"] = {leaf("tiles/b.gltf"), leaf("tiles/b.gltf")};
  EXPECT_EQ(read(root).size(), 60u);
  root["refine"] = "ADD";
  EXPECT_EQ(read(root).size(), 80u);
  root["children"][0]["contents"] = {{{"uri", "tiles/a.glb"}}, {{"uri", "tiles/a.glb"}}};
  EXPECT_EQ(read(root).size(), 120u);
}

// z is up: a move along z is one towards -y.
TEST_F(Tileset, TransformsAreComposed) {
  write("a.glb", test::gltf_of(one).glb());
  Json child = leaf("a.glb");
  child["transform"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1};
  const Json root = {{"transform", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 7, 8, 0, 1}},
                     {"children", {child}}};
  const GaussianCloud found = read(root);
  ASSERT_EQ(found.size(), one.size());
  for (size_t i = 0; i < one.size(); ++i) {
    EXPECT_NEAR(found.position[3 * i], 2 * one.position[3 * i] - 7, 1e-5);
    EXPECT_NEAR(found.position[3 * i + 1], 2 * one.position[3 * i + 1] - 10, 1e-5);
    EXPECT_NEAR(found.position[3 * i + 2], 2 * one.position[3 * i + 2] - 8, 1e-5);
    EXPECT_NEAR(found.log_scale[3 * i], one.log_scale[3 * i] + std::log(2), 1e-5);
  }
}

// On the globe: the origin keeps what binary32 could not.
TEST_F(Tileset, TilesFarAwayHaveAnOrigin) {
  write("a.glb", test::gltf_of(one).glb());
  Json root = leaf("a.glb");
  root["transform"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4.2e6, 171e3, 4.78e6, 1};
  const GaussianCloud found = read(root);
  for (size_t i = 0; i < one.size(); ++i)
    EXPECT_NEAR(found.origin[1] + double{found.position[3 * i + 1]},
                double{one.position[3 * i + 1]} - 4.78e6, 1e-3);
}

TEST_F(Tileset, OtherTilesetsBelongToIt) {
  write("sub/deeper/a.glb", test::gltf_of(one).glb());
  Json inner = leaf("deeper/a.glb");
  inner["transform"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1};
  write("sub/inner.json", tiles(inner));
  Json root = leaf("sub/inner.json");
  root["transform"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 1};
  const GaussianCloud found = read(root);
  ASSERT_EQ(found.size(), one.size());
  EXPECT_NEAR(found.position[0], one.position[0] - 3, 1e-5);
}

TEST_F(Tileset, NamesWhatItDoesNotRead) {
  write("a.glb", test::gltf_of(one).glb());
  write("b.b3dm", test::bytes_of("b3dm...."));
  write("self.json", tiles(leaf("self.json")));
  write("c.json", tiles(leaf("a.glb")));
  Json implicit = leaf("a.glb"), flat = leaf("a.glb"), refine = leaf("a.glb");
  implicit["implicitTiling"] = {{"subtreeLevels", 2}};
  flat["transform"] = {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1};
  refine["refine"] = "MAYBE";
  const std::vector<std::pair<Json, std::string>> bad = {
      {implicit, "implicit tiles"},
      {flat, "none that flattens"},
      {refine, "ADD or REPLACE"},
      {leaf("b.b3dm"), "begins with b3dm"},
      {leaf("../outside.glb"), "in the same folder or below"},
      {leaf("http://127.0.0.1/a.glb"), "a data: URI, or a file"},
      {leaf("self.json"), "self.json once more"},
      {leaf("tileset.json"), "tileset.json once more"},
      {{{"children", {leaf("c.json"), leaf("./c.json")}}}, "c.json once more"},
      {Json::object(), "no content of a leaf"},
      {Json::array(), "an object"},
  };
  for (const auto& [root, said] : bad) {
    const std::string message = refusal(root);
    EXPECT_NE(message.find(said), std::string::npos) << said << ": " << message;
  }
  EXPECT_THROW(read(leaf("missing.glb")), Error);
  Json required = tiles(leaf("a.glb"));
  required["extensionsRequired"] = {"3DTILES_implicit_tiling"};
  write("tileset.json", required);
  EXPECT_NE(test::refusal_of([&] {
              test::import_file(folder.file("tileset.json"));
            }).find("3DTILES_implicit_tiling"),
            std::string::npos);
}

using Opened = std::map<std::string, int>;

// A file that counts how often others are opened from it.
class CountingSource final : public ByteSource {
 public:
  CountingSource(std::unique_ptr<ByteSource> source, Opened& opened)
      : source_(std::move(source)), opened_(opened) {}
  const std::string& name() const override { return source_->name(); }
  uint64_t size() const override { return source_->size(); }
  void read(uint64_t offset, std::span<std::byte> into) const override {
    source_->read(offset, into);
  }
  std::unique_ptr<ByteSource> open_beside(const std::string& path) const override {
    ++opened_[path];
    return source_->open_beside(path);
  }

 private:
  std::unique_ptr<ByteSource> source_;
  Opened& opened_;
};

// To tell what it is, for its header, and for its Gaussians: however many tiles name it.
TEST_F(Tileset, AFileThatTilesNameInTurnsIsOpenedThreeTimes) {
  write("a.glb", test::gltf_of(one).glb());
  write("b.glb", test::gltf_of(two).glb());
  Json root = {{"children", Json::array()}};
  for (int i = 0; i < 5; ++i)
    for (const char* uri : {"a.glb", "b.glb"}) root["children"].push_back(leaf(uri));
  write("tileset.json", tiles(root));
  Opened opened;
  const auto source =
      std::make_shared<CountingSource>(open_file_source(folder.file("tileset.json")), opened);
  const GaussianCloud cloud = import_gaussians(source);
  EXPECT_EQ(cloud.size(), 5 * (one.size() + two.size()));
  EXPECT_EQ(opened, (Opened{{"a.glb", 3}, {"b.glb", 3}}));
}

TEST_F(Tileset, ManyTilesOfOneFileAreBounded) {
  write("a.glb", test::gltf_of(test::random_cloud(5000, 1, 0)).glb());
  Json root = {{"children", Json::array()}};
  for (int i = 0; i < 3000; ++i) root["children"].push_back(leaf("a.glb"));
  const std::string message = refusal(root);  // of the first that is too much
  EXPECT_NE(message.find("000, expected at most "), std::string::npos) << message;
}

// However many tiles there are.
TEST_F(Tileset, WhatIsLeftOutOfTilesIsToldOnce) {
  Bytes spz = test::planar_spz(3, 2, 3);
  spz[12] = std::byte{4};
  spz.resize(spz.size() + 2 * 27);
  Json root = {{"children", Json::array()}};
  for (int i = 0; i < 40; ++i) {
    test::GltfFile file;
    const Json view = {{"bufferView", file.add_view(i % 2 == 0 ? spz : test::planar_spz(3, 2, 1))}};
    file.add_node(
        {{"mesh", file.add_mesh(Json::array(
                      {{{"extensions",
                         {{gltf::kSplatting, {{"extensions", {{gltf::kSpz2, view}}}}}}}}}))}});
    write(std::to_string(i) + ".glb", file.glb());
    root["children"].push_back(leaf(std::to_string(i) + ".glb"));
  }
  write("tileset.json", tiles(root));
  EXPECT_EQ(
      left_out_of(*open_file_source(folder.file("tileset.json"))),
      std::vector<std::string>{"spherical harmonics of degree 4, of 20 of the 40 SPZ inside"});
}

TEST_F(Tileset, EveryFieldMissingOrAbsurd) {
  const std::string uri = "data:;base64," + test::base64(test::gltf_of(one).glb());
  Json root = leaf(uri);
  root["refine"] = "ADD";
  root["transform"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1};
  root["children"] = {leaf(uri), {{"contents", {{{"uri", uri}}}}}};
  test::for_bad_fields(tiles(root), [](const Json& bad, const std::string& what) {
    try {
      EXPECT_LE(test::import_source(test::bytes_of(bad.dump())).size(), 60u) << what;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::refused_input) << what << ": " << error.what();
    }
  });
}

TEST_F(Tileset, EveryTruncationIsRefused) {
  write("a.glb", test::gltf_of(one).glb());
  const Bytes whole = test::bytes_of(tiles(leaf("a.glb")).dump());
  for (size_t size = 0; size < whole.size(); ++size) {
    write("tileset.json", Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
    EXPECT_NE(test::refusal_of([&] { test::import_file(folder.file("tileset.json")); }), "")
        << size;
  }
}

}  // namespace
}  // namespace voyager::tileset_test
