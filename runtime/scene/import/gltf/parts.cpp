#include "runtime/scene/import/gltf/parts.h"

#include "runtime/scene/import/forwarded_blocks.h"
#include "runtime/scene/import/placed_blocks.h"
#include "runtime/scene/transform.h"

namespace voyager::gltf {
namespace {

// Keeps the scene that it reads from.
class SceneReader final : public ForwardedBlocks {
 public:
  SceneReader(std::shared_ptr<const Scene> scene, std::unique_ptr<BlockReader> reader)
      : ForwardedBlocks(std::move(reader)), scene_(std::move(scene)) {}

 private:
  std::shared_ptr<const Scene> scene_;
};

}  // namespace

std::vector<BlockPart> parts_of(const Scene& scene, const OpenScene& open, const Affine& place,
                                const std::array<double, 3>& origin, const std::string& name) {
  std::vector<BlockPart> parts;
  for (size_t i = 0; i < scene.instances().size(); ++i) {
    const Instance& instance = scene.instances()[i];
    const Primitive& primitive = scene.primitive(instance);
    const Affine there = place * instance.place;
    if (there.linear == Mat3d{}) continue;  // a scale of zero is how a node is hidden
    const std::string what = name + ": the node of " + primitive.place;
    const NativeScale native = CloudTransform(there, what).of(primitive.native);
    parts.push_back({primitive.count, primitive.sh_degree, native, [open, i, there, origin, what] {
                       std::shared_ptr<const Scene> from = open();
                       auto reader =
                           place_blocks(from->open(from->instances()[i]), there, origin, what);
                       return std::make_shared<SceneReader>(std::move(from), std::move(reader));
                     }});
  }
  return parts;
}

}  // namespace voyager::gltf
