#pragma once
#include <string>

#include "runtime/base/progress.h"

namespace voyager::view {

// Bakes one flat scene as `voyager bake` does without options, in at most half of the machine's
// memory. While another process bakes the same to the same output, waits for that one's. `progress`
// may throw to end the work; what was begun is then removed. Throws as bake_in_parts() does.
void bake_scene(const std::string& scene, const std::string& output, const Progress& progress);

}  // namespace voyager::view
