#include "runtime/lod/shape.h"

namespace voyager {
namespace {

void split(uint32_t size, uint32_t unit, int times, Parts& parts) {
  if (times == 0 || size <= unit) {
    parts.size[parts.count++] = size;
    return;
  }
  const uint32_t lower = lower_part(size, unit);
  split(lower, unit, times - 1, parts);
  split(size - lower, unit, times - 1, parts);
}

}  // namespace

Parts split_in_parts(uint32_t size) {
  Parts parts{};
  split(size, split_unit(size), 2, parts);
  return parts;
}

uint64_t count_nodes(uint32_t gaussians) {
  if (gaussians <= 1) return gaussians;
  const Parts parts = split_in_parts(gaussians);
  uint64_t nodes = 1;
  for (uint32_t i = 0; i < parts.count; ++i) nodes += count_nodes(parts.size[i]);
  return nodes;
}

}  // namespace voyager
