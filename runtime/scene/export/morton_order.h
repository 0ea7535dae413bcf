#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace voyager {

// Indices of points along the Morton curve over their bounds, ties by index. positions: x, y, z of
// each, finite; at most 2^32 points.
std::vector<uint32_t> morton_order(std::span<const float> positions);

}  // namespace voyager
