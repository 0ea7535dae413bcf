#pragma once
// METHOD §12's truth: a pixel is the mean of its samples.
#include <cstdint>
#include <vector>

namespace voyager::tools {

// samples: RGBA of an image of width·side x height·side, row by row. The mean of each square of
// side x side samples, summed in double.
std::vector<float> mean_of_samples(const std::vector<float>& samples, uint32_t width,
                                   uint32_t height, uint32_t side);

// As VOY_COLOR_FORMAT_RGBA8_UNORM has it: clamped, rounded to nearest.
std::vector<uint8_t> to_rgba8(const std::vector<float>& rgba);

}  // namespace voyager::tools
