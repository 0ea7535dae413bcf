#pragma once
// What a picture of a cut would gain by each merged node's being refined, all others as they are.
#include "runtime/lod/baked_scene.h"
#include "runtime/refine/picture.h"

namespace voyager {

struct NodeGain {
  uint32_t node;  // a merged one
  double squares;  // by how much the sum of squared errors falls, code values² × pixels; < 0: grows
};

// cut: a picture of a cut of the scene. leaves: of all its leaves, the same view. One entry for
// each merged node that reaches the picture, ascending; sums do not depend on how threads take
// turns.
std::vector<NodeGain> gains(const ProjectParams& params, const NodeArrays& arrays,
                            const LodTree& tree, const Picture& cut, const Picture& leaves,
                            Workers& workers);

}  // namespace voyager
