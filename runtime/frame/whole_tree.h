#pragma once
// Records of all nodes, which frames do without: searches of a cut have their own of interior
// nodes, and a leaf has no size of its own (runtime/select/search_tree.h).
#include <memory>

#include "runtime/frame/scene.h"

namespace voyager {

// Of a resident scene whose search is made. How many children a node has is known still
// (node_links.h). The records stay where leaves have extents or a chunk is damaged.
void leave_out_records(Scene& scene);
// The tree with a record for each node: the scene's, or made from the search's. A leaf then has its
// parent's box, in which it lies, and an extent of 0: no search tells that from its own. The scene
// outlives it.
std::shared_ptr<const LodTree> whole_tree(const Scene& scene);

}  // namespace voyager
