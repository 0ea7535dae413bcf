#include "runtime/lod/shape.h"

namespace voyager {
namespace {

void split(uint32_t size, const KdRule& rule, uint32_t times, Parts& parts) {
  if (times == 0 || size <= rule.block) {
    parts.size[parts.count++] = size;
    return;
  }
  const uint32_t lower = lower_part(size, rule);
  split(lower, rule, times - 1, parts);
  split(size - lower, rule, times - 1, parts);
}

void add_parts(Range range, uint32_t most, const KdRule& rule, std::vector<Range>& parts) {
  if (range.size <= most) {
    parts.push_back(range);
    return;
  }
  const uint32_t lower = lower_part(range.size, rule);
  add_parts({range.begin, lower}, most, rule, parts);
  add_parts({range.begin + lower, range.size - lower}, most, rule, parts);
}

}  // namespace

Parts split_in_parts(uint32_t size, const KdRule& rule) {
  Parts parts{};
  split(size, rule, rule.splits, parts);
  return parts;
}

std::vector<Range> parts_of(uint32_t size, uint32_t most, const KdRule& rule) {
  std::vector<Range> parts;
  if (size > 0) add_parts({0, size}, most, rule, parts);
  return parts;
}

}  // namespace voyager
