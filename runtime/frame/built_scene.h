#pragma once
#include <memory>

#include "runtime/frame/scene.h"
#include "runtime/lod/baked_scene.h"

namespace voyager {

// A tree that was just built as backends draw it, before it is written: resident, with no
// partition, so that only the exhaustive search finds its cuts.
std::shared_ptr<Scene> scene_of(const BakedScene& baked, Workers& workers);

}  // namespace voyager
