#pragma once
#include <string>

#include "runtime/base/progress.h"
#include "runtime/format/reader.h"

namespace voyager {

// Writes the tree in HierarchicalGS's float layout (docs/voy-format.md, "The
// .hier export"): Gaussians in the order of nodes, the further ones of a node after
// its own, leaves turned by their axis codes, scene-local positions. Memory: 12 bytes a
// node, 12 more for each with further Gaussians. Throws Error(damaged_chunk), Error(refused_input)
// where a chunk does not go on with the tree (tree_check.h), Error(io), and Error(unsupported)
// where a count does not fit an int32.
void export_hier(const SceneFile& scene, const std::string& path, const Progress& progress = {});

}  // namespace voyager
