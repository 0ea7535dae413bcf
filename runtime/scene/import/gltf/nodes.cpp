#include "runtime/scene/import/gltf/nodes.h"

#include <array>
#include <cmath>

#include "runtime/scene/import/gltf/file.h"

namespace voyager::gltf {
namespace {

// Translation · rotation · scale.
Affine place_of(const JsonValue& node) {
  if (node.has("matrix")) return matrix_of(node["matrix"]);
  std::array<double, 3> move{0, 0, 0}, scale{1, 1, 1};
  std::array<double, 4> turn{0, 0, 0, 1};
  if (node.has("translation")) node["translation"].numbers(move);
  if (node.has("rotation")) node["rotation"].numbers(turn);
  if (node.has("scale")) node["scale"].numbers(scale);
  if (turn == std::array<double, 4>{0, 0, 0, 0}) node["rotation"].refuse("a unit quaternion");
  const Mat3d r = rotation(normalise(Quatd{turn[3], turn[0], turn[1], turn[2]}));
  return {r * Mat3d{{{scale[0], 0, 0}, {0, scale[1], 0}, {0, 0, scale[2]}}},
          {move[0], move[1], move[2]}};
}

struct Visit {
  uint32_t node;
  Affine parent;
};

// From the scene's nodes down, without recursion: files may nest as deep as they like.
class Walk {
 public:
  explicit Walk(const JsonValue& json) : json_(json) {
    if (!json.has("scene") && !json.has("scenes")) return;
    const JsonValue scene = json["scenes"][json.whole_or("scene", 0, kMostIndex)];
    if (!scene.has("nodes")) return;
    seen_.resize(json["nodes"].size());
    add(scene["nodes"], {});
  }

  std::vector<MeshNode> run() {
    std::vector<MeshNode> found;
    while (!visits_.empty()) {
      const Visit visit = visits_.back();
      visits_.pop_back();
      const JsonValue node = json_["nodes"][visit.node];
      const Affine place = visit.parent * place_of(node);
      if (node.has("mesh"))
        found.push_back({visit.node, static_cast<uint32_t>(node["mesh"].whole(kMostIndex)), place});
      if (node.has("children")) add(node["children"], place);
    }
    return found;
  }

 private:
  // The first is taken first.
  void add(const JsonValue& indices, const Affine& parent) {
    for (size_t i = indices.size(); i-- > 0;) {
      const uint64_t node = indices[i].whole(kMostIndex);
      if (node >= seen_.size())
        indices[i].refuse("a node, of which there are " + std::to_string(seen_.size()));
      if (seen_[node])
        indices[i].refuse("node " + std::to_string(node) + " once more",
                          "each node below one other at most");
      seen_[node] = true;
      visits_.push_back({static_cast<uint32_t>(node), parent});
    }
  }

  const JsonValue& json_;
  std::vector<bool> seen_;
  std::vector<Visit> visits_;
};

}  // namespace

Affine matrix_of(const JsonValue& json) {
  std::array<double, 16> m;
  json.numbers(m);
  constexpr double kRounding = 1e-6;  // of writers of binary32
  if (std::fabs(m[3]) > kRounding || std::fabs(m[7]) > kRounding || std::fabs(m[11]) > kRounding ||
      std::fabs(m[15] - 1) > kRounding)
    json.refuse("another last row", "0, 0, 0, 1 at each fourth number");
  return {{{{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}}}, {m[12], m[13], m[14]}};
}

std::vector<MeshNode> mesh_nodes(const JsonValue& json) {
  return Walk(json).run();
}

}  // namespace voyager::gltf
