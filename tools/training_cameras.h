#pragma once
// The cameras that a scene was trained with, from what the tools around 3DGS write.
#include <string>
#include <vector>

#include "runtime/scene/training_camera.h"

namespace voyager::tools {

// `path` is one of
// - INRIA's cameras.json,
// - COLMAP's model, text or binary: its folder, the folder above its sparse/0 or sparse, or one of
//   its files cameras.* and images.*, which then lie side by side,
// - nerfstudio's transforms.json,
// - a folder with one of the two .json under these names.
// What a file holds decides how it is read, not its name. Where dataparser_transforms.json lies
// beside a transforms.json or a model, the cameras are brought to the world that it describes
// (training_cameras/dataparser.h). Throws Error(refused_input) naming file, place, found, expected,
// and what open_file_source() does.
std::vector<TrainingCamera> read_training_cameras(const std::string& path);

// The same camera with a picture smaller by this factor, which is at least 1.
TrainingCamera downscaled(const TrainingCamera& camera, double factor);

// The files say how large the pictures were taken, not how large they were when a scene was trained
// with them. INRIA's trainer, unless told otherwise, brings those wider than this to this width,
// and nerfstudio halves until they fit.
inline constexpr uint32_t kUsualTrainingWidth = 1600;
double usual_downscale(const TrainingCamera& camera);  // INRIA's

}  // namespace voyager::tools
