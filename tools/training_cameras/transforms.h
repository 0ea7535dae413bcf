#pragma once
#include <string>
#include <vector>

#include "runtime/scene/training_camera.h"

namespace voyager::tools {

// nerfstudio's transforms.json. Its transform_matrix is view to world with OpenGL's axes: x right,
// y up, z backward. What belongs to the camera is read from the frame, else from the top: w, h,
// fl_x or camera_angle_x, fl_y or camera_angle_y, cx, cy. fl_y is as fl_x and the centre is the
// picture's where they are absent.
//
// The world is that of transform_matrix, in which INRIA's trainer and Brush put their Gaussians.
// nerfstudio's own turns, moves and scales it before it trains, and the .ply that it exports is in
// that other world. Nothing in the .ply or in transforms.json says how; dataparser_transforms.json,
// which it writes beside the trained model, does (dataparser.h).
std::vector<TrainingCamera> read_transforms(const std::string& path);

}  // namespace voyager::tools
