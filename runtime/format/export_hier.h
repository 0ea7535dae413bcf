#pragma once
#include <string>

#include "runtime/base/progress.h"
#include "runtime/format/reader.h"

namespace voyager {

// Writes the tree in HierarchicalGS's float layout (docs/voy-format.md, "The
// .hier export"): one Gaussian a node, Gaussian index = node index = node id,
// leaves turned by their axis codes, scene-local positions. Memory: 12 bytes a
// node. Throws Error(damaged_chunk), Error(refused_input) where a chunk does not go
// on with the tree (tree_check.h), Error(io), and Error(unsupported) where a count
// does not fit an int32.
void export_hier(const SceneFile& scene, const std::string& path, const Progress& progress = {});

}  // namespace voyager
