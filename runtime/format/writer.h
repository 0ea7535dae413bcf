#pragma once
#include <string>

#include "runtime/base/progress.h"
#include "runtime/base/workers.h"
#include "runtime/format/layout.h"
#include "runtime/lod/baked_scene.h"

namespace voyager {

// `partition` is of the scene's tree. The file appears whole or not at all
// (AtomicFile). Throws Error(io).
void write_scene_file(const BakedScene& baked, const Partition& partition, const std::string& path,
                      Quality quality, Workers& workers, const Progress& progress = {});

}  // namespace voyager
