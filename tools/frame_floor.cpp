#include "tools/frame_floor.h"

#include <algorithm>

namespace voyager::tools {
namespace {

constexpr double kMeanBytes = 12;       // three binary32
constexpr double kSplatBytes = 28;      // written by projection
constexpr double kDepthSortBytes = 68;  // of a splat, in 32-bit keys
constexpr double kTileSortBytes = 26;   // of a pair, in 16-bit keys

}  // namespace

FrameFloor frame_floor(const FrameWork& work, const DeviceRates& rates) {
  const double project =
      work.cut * kMeanBytes + work.splats * (work.attribute_bytes - kMeanBytes + kSplatBytes);
  const double sort = work.splats * kDepthSortBytes + work.pairs * kTileSortBytes;
  return {stage_floor(project, 0, rates), stage_floor(sort, 0, rates),
          stage_floor(0, work.pixels_blended * kBlendInstructions, rates),
          stage_floor(work.pixels * work.pixel_bytes, 0, rates)};
}

double stage_floor(double bytes, double instructions, const DeviceRates& rates) {
  return 1000 * std::max(bytes / rates.bytes, instructions / rates.lane_instructions);
}

double stored_bytes(int sh_degree) {
  const int floats = 3 + 4 + 3 + 1 + 3 * (sh_degree + 1) * (sh_degree + 1);
  return 4.0 * floats;
}

double attribute_bytes(double gaussian_bytes, int sh_degree) {
  return gaussian_bytes > 0 ? gaussian_bytes : stored_bytes(sh_degree);
}

}  // namespace voyager::tools
