#pragma once
// METHOD §12's native pixel of inputs that are joined: where the estimates differ, because one was
// scaled or made from nearer pictures, each input has a footprint level of its own.
#include <span>
#include <vector>

#include "runtime/scene/scale_histogram.h"

namespace voyager {

// Of one input: its Gaussians end before `end`, counted over all inputs in their order.
struct InputScales {
  uint32_t end = 0;
  ScaleHistogram scales;
};
struct InputLevel {
  uint32_t end;
  uint32_t level;  // below kFootprintLevels
};

struct JoinedScale {
  NativeScale scale;
  std::vector<InputLevel> levels;  // of each input; none where one native pixel does for all
};

// Estimates within a factor of √2 are one, over all Gaussians. Else level 0 is the largest of them,
// or less where the smallest is further below it than levels reach: a pixel that is too small takes
// away no more than training added. An input without an estimate has that over all.
JoinedScale joined_scale(std::span<const InputScales> inputs);

// Of Gaussians at these places over all inputs, ascending; empty where there are no levels.
std::vector<uint8_t> levels_of(std::span<const InputLevel> levels,
                               std::span<const uint32_t> places);
// Of all Gaussians.
std::vector<uint8_t> levels_of(std::span<const InputLevel> levels);

}  // namespace voyager
