#include "runtime/scene/import/gltf/scene.h"

#include <algorithm>
#include <map>

#include "runtime/scene/import/forwarded_blocks.h"
#include "runtime/scene/import/gltf/accessor_blocks.h"
#include "runtime/scene/import/gltf/axes.h"
#include "runtime/scene/import/gltf/nodes.h"
#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/linear_colours.h"

namespace voyager::gltf {
namespace {

// Those that do not concern splats draw nothing that is left out here.
constexpr const char* kKnown[] = {
    "KHR_gaussian_splatting", "KHR_gaussian_splatting_compression_spz",
    "KHR_gaussian_splatting_compression_spz_2", "KHR_materials_unlit", "KHR_mesh_quantization"};

void require_known_extensions(const JsonValue& json) {
  if (!json.has("extensionsRequired")) return;
  const JsonValue required = json["extensionsRequired"];
  for (size_t i = 0; i < required.size(); ++i)
    if (std::find(std::begin(kKnown), std::end(kKnown), required[i].text()) == std::end(kKnown))
      required[i].refuse(
          "KHR_gaussian_splatting, its compression_spz or compression_spz_2, "
          "KHR_materials_unlit or KHR_mesh_quantization: no other extension is read");
}

// Linear colours, encoded.
class EncodedReader final : public ForwardedBlocks {
 public:
  using ForwardedBlocks::ForwardedBlocks;
  GaussianCloud decode(const RawBlock& block) const override {
    GaussianCloud cloud = ForwardedBlocks::decode(block);
    encode_colours(cloud);
    return cloud;
  }
};

}  // namespace

Scene::Scene(File file) : name_(file.name()) {
  const JsonValue json = file.json();
  const JsonValue version = json["asset"]["version"];
  if (version.text().rfind("2.", 0) != 0) version.refuse("\"2.0\"");
  require_known_extensions(json);
  read_instances(file);
  if (instances_.empty())
    json.refuse("no node of the scene with a primitive of KHR_gaussian_splatting", "one");
  bytes_ = file.bytes();
  check_count();
  const bool log_scales = have_log_scales(primitives_);
  for (Primitive& primitive : primitives_) primitive.log_scales = log_scales;
}

void Scene::read_instances(File& file) {
  const JsonValue json = file.json();
  std::map<uint32_t, std::vector<size_t>> known;  // a mesh's primitives
  for (const MeshNode& node : mesh_nodes(json)) {
    const auto [mesh, is_new] = known.try_emplace(node.mesh);
    const JsonValue primitives = json["meshes"][node.mesh]["primitives"];
    for (size_t i = 0; is_new && i < primitives.size(); ++i)
      if (auto primitive = read_primitive(file, primitives[i])) {
        mesh->second.push_back(primitives_.size());
        primitives_.push_back(std::move(*primitive));
      }
    if (mesh->second.empty()) continue;
    constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
    const JsonValue owner = json["nodes"][node.node];
    if (owner.has("extensions") && owner["extensions"].has(kInstancing))
      owner["extensions"].refuse(kInstancing, "none: splats are drawn once for each node");
    const uint64_t placed = instances_.size() + mesh->second.size();
    if (placed > most_parts(sum_of(file.bytes())))
      owner.refuse(std::to_string(placed) + " placed primitives",
                   "at most " + std::to_string(most_parts(sum_of(file.bytes()))));
    for (const size_t primitive : mesh->second)
      instances_.push_back({primitive, in_inria_axes(node.place)});
  }
}

// Nodes may share a primitive, and accessors bytes, or have none.
void Scene::check_count() const {
  int sh_degree = 0;
  uint64_t count = 0;
  for (const Instance& instance : instances_) {
    sh_degree = std::max(sh_degree, primitive(instance).sh_degree);
    if (__builtin_add_overflow(count, primitive(instance).count, &count)) count = UINT64_MAX;
  }
  const uint64_t bytes = sum_of(bytes_);
  const uint64_t most = most_gaussians(bytes, bytes_of_gaussian(sh_degree));
  if (count > most)
    refuse(name_, 0, "Gaussians", std::to_string(count),
           "at most " + std::to_string(most) + " in " + std::to_string(bytes) + " bytes");
}

std::unique_ptr<BlockReader> Scene::open(const Instance& instance) const {
  const Primitive& primitive = primitives_[instance.primitive];
  std::unique_ptr<BlockReader> reader =
      primitive.spz ? open_spz_blocks(primitive.spz) : read_accessors(name_, primitive);
  if (primitive.linear_colours) reader = std::make_unique<EncodedReader>(std::move(reader));
  return reader;
}

}  // namespace voyager::gltf
