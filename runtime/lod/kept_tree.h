#pragma once
// The tree of a .hier as it is, in place of one that is built.
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/base/progress.h"
#include "runtime/lod/baked_scene.h"

namespace voyager {

struct KeptTree {
  BakedScene scene;
  // What the file has and the scene has not.
  uint64_t unused = 0;     // Gaussians that no node has
  uint64_t childless = 0;  // inner nodes without children: leaves of the scene
  uint64_t grown = 0;      // nodes whose box or extent was made to hold its children's
};

// Links, boxes, extents and words are the file's, nodes breadth-first, leaves in the order of its
// Gaussians; opacities are linear throughout (BakedScene::kept), and the origin is 0. Drawn
// Gaussians are sanitised as importers do; SH bands that are zero everywhere are left out. Throws
// Error(refused_input) for links that are no tree, for boxes that are not finite and ordered, for
// extents that are negative, and for a Gaussian that would have to be dropped: the tree needs it.
// Progress stage "reading".
KeptTree read_kept_tree(std::shared_ptr<const ByteSource> source, const Progress& progress = {});

// A sentence for each thing that is left out or mended.
std::vector<std::string> notes_of(const KeptTree& kept);

}  // namespace voyager
