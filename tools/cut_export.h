#pragma once
#include <string>

#include "runtime/scene/export/flat_file.h"
#include "tools/cameras.h"

namespace voyager::tools {

// One camera's interpolated cut as a flat scene, for other renderers. Merged
// opacities above 1 become the largest logit that binary32 tells from 1.
// Returns what was written. Throws also as write_flat_file() does.
FlatContents export_cut(const std::string& scene_path, const Camera& camera, double tau,
                        const std::string& path, const FlatOptions& options);

}  // namespace voyager::tools
