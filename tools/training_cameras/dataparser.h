#pragma once
// nerfstudio trains in a world of its own: dataparser_transforms.json, beside its trained model,
// has the `transform` and then the `scale` that lead there from the world of the pictures as they
// came, COLMAP's say. A transforms.json may have left that world too: it then says by which
// applied_transform and applied_scale.
#include <string>
#include <vector>

#include "runtime/scene/training_camera.h"
#include "tools/json_fields.h"

namespace voyager::tools {

// Brings cameras that came from the file `path` to the world of the dataparser_transforms.json
// beside it; leaves them where there is none. Throws Error(refused_input).
void bring_to_trained_world(std::vector<TrainingCamera>& cameras, const std::string& path);
// The same for those of a transforms.json, of which `top` is the whole.
void bring_to_trained_world(std::vector<TrainingCamera>& cameras, const std::string& path,
                            const JsonFields& top);

}  // namespace voyager::tools
