#pragma once
#include <string>
#include <vector>

#include "runtime/scene/training_camera.h"
#include "tools/training_cameras/byte_window.h"
#include "tools/training_cameras/colmap_model.h"

namespace voyager::tools {

// COLMAP's files cameras.* and images.*, each text or binary. The points that it found in the
// pictures are stepped over. Throws as read_training_cameras() does.
std::vector<TrainingCamera> read_colmap(const std::string& cameras, const std::string& images);

// Files of one kind, for read_colmap.
ColmapLenses read_lenses_text(const ByteSource& file);
ColmapLenses read_lenses_binary(const ByteSource& file);
std::vector<TrainingCamera> read_images_text(const ByteSource& file, const ColmapLenses& lenses);
std::vector<TrainingCamera> read_images_binary(const ByteSource& file, const ColmapLenses& lenses);

}  // namespace voyager::tools
