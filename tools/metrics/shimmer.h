#pragma once
// How much a picture changes while the camera hardly moves:
//   Σ |T_i − T_(i−1)| / Σ |R_i − R_(i−1)|
// over all changes, pixels and r, g, b, of frames T against those of the reference R, as a screen
// shows them. 1: as much as the reference itself; above: what the reference does not do.
#include <optional>
#include <span>
#include <vector>

#include "tools/metrics/screen_pair.h"

namespace voyager::tools {

// Frames of one size, in order; as many of each. None where the reference never changes, or where
// a pixel is not finite.
std::optional<double> shimmer(std::span<const RgbaImage> frames,
                              std::span<const RgbaImage> reference);

}  // namespace voyager::tools
