#include "tools/training_cameras/colmap.h"

#include <algorithm>

namespace voyager::tools {
namespace {

// A binary file begins with a count of 64 bits, which has zeros. Text has none.
bool is_binary(const ByteSource& file) {
  ByteWindow bytes(file);
  return bytes.peek().substr(0, 8).find('\0') != std::string_view::npos;
}

}  // namespace

std::vector<TrainingCamera> read_colmap(const std::string& cameras, const std::string& images) {
  const auto lens_file = open_file_source(cameras), image_file = open_file_source(images);
  const ColmapLenses lenses =
      is_binary(*lens_file) ? read_lenses_binary(*lens_file) : read_lenses_text(*lens_file);
  std::vector<TrainingCamera> all = is_binary(*image_file) ? read_images_binary(*image_file, lenses)
                                                           : read_images_text(*image_file, lenses);
  if (all.empty()) refuse_cameras(images, "no image", "at least one");
  return all;
}

}  // namespace voyager::tools
