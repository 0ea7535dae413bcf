#include "runtime/format/plane_order.h"

#include <algorithm>

#include "runtime/lod/tree.h"

namespace voyager {
namespace {

template <class IsTold>
PlaneOrder order_of(size_t count, const IsTold& is_told) {
  PlaneOrder order;
  std::vector<uint32_t> told;
  for (uint32_t i = 0; i < count; ++i) (is_told(i) ? told : order.item).push_back(i);
  order.plain = order.item.size();
  order.item.insert(order.item.end(), told.begin(), told.end());
  return order;
}

// Children have higher numbers than their parents.
void tell_children_first(PlaneOrder& order) {
  std::reverse(order.item.begin() + static_cast<std::ptrdiff_t>(order.plain), order.item.end());
}

}  // namespace

PlaneOrder box_order(const Families& families) {
  PlaneOrder order = order_of(families.children.size(),
                              [&](uint32_t i) { return families.children[i].count != 0; });
  tell_children_first(order);
  return order;
}

PlaneOrder extent_order(const Families& families, const ChunkCounts& counts) {
  return order_of(counts.of_record.size(), [&](uint32_t i) {
    return counts.of_record[i] <= 1 && families.parent[i] != kNoNode;
  });
}

GaussianOrder gaussian_order(const Families& families, const ChunkCounts& counts,
                             std::span<const uint32_t> record) {
  std::vector<uint32_t> owned(counts.of_record.size(), kNoNode);
  for (uint32_t i = 0; i < record.size(); ++i) owned[record[i]] = i;
  // A leaf's words are another kind than a merged Gaussian's.
  const auto child_of = [&](uint32_t i) {
    const Families::Run& children = families.children[record[i]];
    return children.count == 1 && counts.of_record[children.first] != 0 ? owned[children.first]
                                                                        : kNoNode;
  };
  GaussianOrder order{order_of(record.size(), [&](uint32_t i) { return child_of(i) != kNoNode; }),
                      {}};
  tell_children_first(order);
  for (size_t at = order.plain; at < order.item.size(); ++at)
    order.child.push_back(child_of(order.item[at]));
  return order;
}

}  // namespace voyager
