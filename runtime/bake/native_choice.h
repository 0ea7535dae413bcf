#pragma once
// Where a bake has METHOD §12's native pixel from: inputs that were trained with a compensated
// filter say so; else whoever bakes gives it, or the cameras that the scene was trained with; else
// it is estimated.
#include <optional>
#include <string>
#include <vector>

#include "runtime/bake/input_levels.h"
#include "runtime/lod/block_footprints.h"
#include "runtime/scene/native_pixel.h"

namespace voyager {

struct NativeChoice {
  std::optional<double> pixel;          // metres, 0 to kMaxNativePixel
  std::vector<TrainingCamera> cameras;  // used where no pixel is given; none: inputs or an estimate
};

// A line of a bake's request (bake.h); empty where nothing is chosen.
std::string request_line(const NativeChoice& choice);

struct FoundScale {
  NativeScale scale;
  std::optional<NativePixel> by_cameras{};  // where cameras say it
  std::vector<InputLevel> inputs{};         // JoinedScale's, where they were asked
  // Of a block that no camera sees: the scene's median.
  int unseen_level() const { return by_cameras ? scale.level_of(by_cameras->median) : 0; }
};

// Of a whole cloud, sanitised; `ends` are those of its inputs, or none of one. Inputs that were
// trained with a compensated filter keep their own scale. Throws Error(refused_input) where there
// are cameras and none sees a Gaussian.
FoundScale native_scale(const NativeChoice& choice, const GaussianCloud& cloud,
                        std::span<const uint32_t> ends = {});

// The same from histograms of its parts. of_inputs: as they say.
FoundScale native_scale(const NativeChoice& choice, const NativeScale& of_inputs,
                        const NativePixelHistogram& pixels, std::span<const InputScales> inputs);

}  // namespace voyager
