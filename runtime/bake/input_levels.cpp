#include "runtime/bake/input_levels.h"

#include <algorithm>
#include <cmath>

namespace voyager {

JoinedScale joined_scale(std::span<const InputScales> inputs) {
  ScaleHistogram all;
  for (const InputScales& input : inputs) all.add(input.scales);
  JoinedScale joined{all.estimate(), {}};
  std::vector<double> pixels;
  for (const InputScales& input : inputs) {
    const NativeScale own = input.scales.estimate();
    pixels.push_back(own.source == NativeSource::unknown ? joined.scale.pixel : own.pixel);
  }
  if (pixels.empty()) return joined;
  const auto [least, most] = std::minmax_element(pixels.begin(), pixels.end());
  if (*most <= *least * std::sqrt(2.0)) return joined;
  joined.scale.levels = kFootprintLevels;
  joined.scale.pixel = std::min(*most, *least / std::sqrt(footprint_at(1.0, kFootprintLevels - 1)));
  for (size_t i = 0; i < inputs.size(); ++i)
    joined.levels.push_back(
        {inputs[i].end, static_cast<uint32_t>(joined.scale.level_of(pixels[i]))});
  return joined;
}

std::vector<uint8_t> levels_of(std::span<const InputLevel> levels,
                               std::span<const uint32_t> places) {
  std::vector<uint8_t> found;
  if (levels.empty()) return found;
  size_t input = 0;
  for (const uint32_t place : places) {
    while (input + 1 < levels.size() && place >= levels[input].end) ++input;
    found.push_back(static_cast<uint8_t>(levels[input].level));
  }
  return found;
}

std::vector<uint8_t> levels_of(std::span<const InputLevel> levels) {
  std::vector<uint8_t> found;
  for (const InputLevel& input : levels) found.resize(input.end, static_cast<uint8_t>(input.level));
  return found;
}

}  // namespace voyager
