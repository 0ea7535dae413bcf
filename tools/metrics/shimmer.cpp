#include "tools/metrics/shimmer.h"

#include <cassert>

namespace voyager::tools {
namespace {

double change(std::span<const RgbaImage> frames) {
  double sum = 0;
  for (size_t i = 1; i < frames.size(); ++i)
    for (size_t k = 0; k < frames[i].size(); ++k)
      if (k % 4 != 3) sum += std::fabs(on_screen(frames[i][k]) - on_screen(frames[i - 1][k]));
  return sum;
}

bool all_finite(std::span<const RgbaImage> frames) {
  for (const RgbaImage& frame : frames)
    for (size_t i = 0; i < frame.size(); i += 4)
      if (!is_finite(&frame[i])) return false;
  return true;
}

}  // namespace

std::optional<double> shimmer(std::span<const RgbaImage> frames,
                              std::span<const RgbaImage> reference) {
  assert(frames.size() == reference.size());
  if (!all_finite(frames) || !all_finite(reference)) return std::nullopt;
  const double expected = change(reference);
  if (!(expected > 0)) return std::nullopt;
  return change(frames) / expected;
}

}  // namespace voyager::tools
