#include "runtime/scene/import/gltf/scene.h"

#include <algorithm>
#include <map>

#include "runtime/scene/gltf_format.h"
#include "runtime/scene/import/forwarded_blocks.h"
#include "runtime/scene/import/gltf/accessor_blocks.h"
#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/linear_colours.h"

namespace voyager::gltf {
namespace {

// Those that do not concern splats draw nothing that is left out here.
constexpr const char* kKnown[] = {kSplatting, kSpz1, kSpz2, "KHR_materials_unlit",
                                  "KHR_mesh_quantization"};

void require_known_extensions(const JsonValue& json) {
  if (!json.has("extensionsRequired")) return;
  const JsonValue required = json["extensionsRequired"];
  for (size_t i = 0; i < required.size(); ++i)
    if (std::find(std::begin(kKnown), std::end(kKnown), required[i].text()) == std::end(kKnown))
      required[i].refuse(
          "KHR_gaussian_splatting, its compression_spz or compression_spz_2, "
          "KHR_materials_unlit or KHR_mesh_quantization: no other extension is read");
}

// A transform between glTF's axes, between INRIA's.
Affine in_inria_axes(const Affine& place) {
  return {kToInria.matrix() * place.linear * kToInria.matrix(), kToInria * place.offset};
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
  const bool log_scales = have_log_scales(primitives_);
  for (Primitive& primitive : primitives_) primitive.log_scales = log_scales;
}

void Scene::read_instances(File& file) {
  const JsonValue json = file.json();
  SpzViews views;
  std::map<uint32_t, std::vector<size_t>> known;  // a mesh's primitives
  for (const MeshNode& node : mesh_nodes(json)) {
    const auto [mesh, is_new] = known.try_emplace(node.mesh);
    const JsonValue primitives = json["meshes"][node.mesh]["primitives"];
    for (size_t i = 0; is_new && i < primitives.size(); ++i)
      if (auto primitive = read_primitive(file, views, primitives[i])) {
        total_bytes_ = sum_of(file.bytes());
        add_count(*primitive);
        mesh->second.push_back(primitives_.size());
        primitives_.push_back(std::move(*primitive));
      }
    for (size_t i = 0; !is_new && i < mesh->second.size(); ++i)
      add_count(primitives_[mesh->second[i]]);
    if (!mesh->second.empty()) place(node, mesh->second, file);
  }
  bytes_ = file.bytes();
  left_out_ = views.left_out();
}

void Scene::place(const MeshNode& node, const std::vector<size_t>& primitives, const File& file) {
  constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
  const JsonValue json = file.json();
  const JsonValue owner = json["nodes"][node.node];
  if (owner.has("extensions") && owner["extensions"].has(kInstancing))
    owner["extensions"].refuse(kInstancing, "none: splats are drawn once for each node");
  const uint64_t placed = instances_.size() + primitives.size();
  if (placed > most_parts(total_bytes_))
    owner.refuse(std::to_string(placed) + " placed primitives",
                 "at most " + std::to_string(most_parts(total_bytes_)));
  for (const size_t primitive : primitives)
    instances_.push_back({primitive, in_inria_axes(node.place)});
}

// Nodes may share a primitive, and accessors bytes, or have none. Counted as they come, before the
// next is opened.
void Scene::add_count(const Primitive& primitive) {
  sh_degree_ = std::max(sh_degree_, primitive.sh_degree);
  if (__builtin_add_overflow(count_, primitive.count, &count_)) count_ = UINT64_MAX;
  const uint64_t most = most_gaussians(total_bytes_, bytes_of_gaussian(sh_degree_));
  if (count_ > most)
    refuse(name_, 0, "Gaussians", std::to_string(count_),
           "at most " + std::to_string(most) + " in " + std::to_string(total_bytes_) + " bytes");
}

std::unique_ptr<BlockReader> Scene::open(const Instance& instance) const {
  const Primitive& primitive = primitives_[instance.primitive];
  std::unique_ptr<BlockReader> reader =
      !primitive.spz           ? read_accessors(name_, primitive)
      : primitive.spz_to_inria ? spz::open_in_axes(primitive.spz, *primitive.spz_to_inria)
                               : open_spz_blocks(primitive.spz);
  if (primitive.linear_colours) reader = std::make_unique<EncodedReader>(std::move(reader));
  return reader;
}

}  // namespace voyager::gltf
