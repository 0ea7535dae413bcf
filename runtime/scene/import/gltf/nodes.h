#pragma once
// The nodes of a scene, and where they are.
#include <vector>

#include "runtime/math/affine.h"
#include "runtime/scene/import/json_value.h"

namespace voyager::gltf {

struct MeshNode {
  uint32_t node, mesh;
  Affine place;  // from the node to the scene, in the file's axes
};

// Those with a mesh, of the scene that `scene` names, else of the first. Throws
// Error(refused_input) where a node has two parents or is its own.
std::vector<MeshNode> mesh_nodes(const JsonValue& json);

// 16 numbers, column by column, of which the last row is 0, 0, 0, 1.
Affine matrix_of(const JsonValue& json);

}  // namespace voyager::gltf
