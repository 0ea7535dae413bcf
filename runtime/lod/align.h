#pragma once
#include "runtime/lod/baked_scene.h"

namespace voyager {

// A node's stored rotation, unit, in double.
Quatd stored_rotation(uint32_t node, const BakedScene& baked);

// Turns the axes of a node's children to the assignment nearest its own, which
// is final (top down): merged children are stored turned, leaves keep their
// words and get a code. Nodes of one level may be done at once.
void align_children(uint32_t node, BakedScene& baked);

}  // namespace voyager
