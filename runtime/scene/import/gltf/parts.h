#pragma once
// The splats of a glTF file as parts of a scene.
#include <functional>

#include "runtime/scene/import/gltf/scene.h"
#include "runtime/scene/import/merged_blocks.h"

namespace voyager::gltf {

// Gives the scene of a file, opening it where nobody has it open.
using OpenScene = std::function<std::shared_ptr<const Scene>()>;

// Each instance of `scene`, which `open` gives, moved by `place` (INRIA axes), relative to
// `origin`. Throws Error(refused_input) where an instance is moved in a way that CloudTransform
// refuses.
std::vector<BlockPart> parts_of(const Scene& scene, const OpenScene& open, const Affine& place,
                                const std::array<double, 3>& origin, const std::string& name);

}  // namespace voyager::gltf
