#include "runtime/scene/import/gltf/parts.h"
#include "runtime/scene/transform.h"

namespace voyager {

std::unique_ptr<BlockReader> open_gltf_blocks(std::shared_ptr<const ByteSource> source) {
  const std::string name = source->name();
  const auto scene = std::make_shared<const gltf::Scene>(gltf::File(std::move(source)));
  const auto origin = origin_near(scene->instances().front().place.offset);
  return merge_blocks(name, gltf::parts_of(
                                *scene, [scene] { return scene; }, {}, origin, name));
}

}  // namespace voyager
