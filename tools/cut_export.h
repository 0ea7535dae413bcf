#pragma once
#include <string>

#include "tools/cameras.h"

namespace voyager::tools {

// One camera's interpolated cut as a flat scene, for other renderers. Merged
// opacities above 1 become the largest logit that binary32 tells from 1.
void export_cut(const std::string& scene_path, const Camera& camera, double tau,
                const std::string& ply_path);

}  // namespace voyager::tools
