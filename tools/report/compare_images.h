#pragma once
#include <vector>

#include "runtime/base/workers.h"
#include "tools/metrics/screen_pair.h"
#include "tools/report/report_row.h"

namespace voyager::tools {

// Of a path, ascending.
struct ComparedFrame {
  size_t index;
  size_t width;  // pixels
};

// Means over the frames; popping over those of them that follow one another in one size. The
// images are the frames', in order, not empty. first_flip: where not null, gets FLIP at each pixel
// of the first.
ReportError compare_images(const std::vector<RgbaImage>& images,
                           const std::vector<RgbaImage>& expected,
                           const std::vector<ComparedFrame>& frames, Workers& workers,
                           std::vector<float>* first_flip = nullptr);

}  // namespace voyager::tools
