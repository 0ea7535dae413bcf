#pragma once
// METHOD §12's truth of a path's frames: what a report judges pictures by.
#include <filesystem>
#include <memory>
#include <vector>

#include "tools/frame_bench.h"

namespace voyager::tools {

// Of one frame: every leaf, the mean of 8 x 8 samples a pixel, or of 4 x 4 where 8 x 8 would take
// more than half a gigabyte (16 bytes a sample). A scene of which nobody knows the native pixel has
// no truth: this is then every leaf at the picture's own size.
RgbaImage truth_image(const FrameMaker& maker, FrameInput frame);

class TruthImages {
 public:
  // Of `chosen` of a path's frames, drawn at first use and kept in `folder`, under their numbers
  // from first_number on.
  TruthImages(const FrameMaker& maker, std::vector<FrameInput> path, std::vector<size_t> chosen,
              std::filesystem::path folder, size_t first_number);

  const std::vector<RgbaImage>& get();

 private:
  FrameMaker maker_;
  std::vector<FrameInput> path_;
  std::vector<size_t> chosen_;
  std::filesystem::path folder_;
  size_t first_number_;
  std::vector<RgbaImage> images_;
};

}  // namespace voyager::tools
