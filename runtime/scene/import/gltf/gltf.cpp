#include "runtime/scene/import/gltf/parts.h"
#include "runtime/scene/import/tileset/tileset.h"
#include "runtime/scene/transform.h"

namespace voyager {
namespace {

std::unique_ptr<BlockReader> open_file(gltf::File file) {
  const std::string name = file.name();
  auto scene = std::make_shared<const gltf::Scene>(std::move(file));
  const auto origin = origin_near(scene->instances().front().place.offset);
  return merge_blocks(name,
                      gltf::parts_of(
                          *scene, [scene] { return scene; }, {}, origin, name),
                      origin);
}

}  // namespace

std::unique_ptr<BlockReader> open_glb_blocks(std::shared_ptr<const ByteSource> source) {
  return open_file(gltf::File(std::move(source)));
}

std::vector<std::string> left_out_of_gltf(std::shared_ptr<const ByteSource> source) {
  if (gltf::is_binary(*source)) return gltf::Scene(gltf::File(source)).left_out().texts();
  nlohmann::json json = gltf::read_json(*source);
  if (tileset::is_tileset(json)) return tileset::left_out(source, std::move(json)).texts();
  return gltf::Scene(gltf::File(source, std::move(json))).left_out().texts();
}

std::unique_ptr<BlockReader> open_json_blocks(std::shared_ptr<const ByteSource> source) {
  nlohmann::json json = gltf::read_json(*source);
  if (tileset::is_tileset(json)) return tileset::open(std::move(source), std::move(json));
  return open_file(gltf::File(std::move(source), std::move(json)));
}

}  // namespace voyager
