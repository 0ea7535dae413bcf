#include "runtime/lod/kd_layout.h"

#include "runtime/lod/kd_order.h"
#include "runtime/lod/shape.h"

namespace voyager {
namespace {

// Visits nodes depth-first, as the order has their Gaussians: the nodes of one level are
// then met in the order that they have breadth-first.
class LayoutWriter {
 public:
  explicit LayoutWriter(const std::vector<uint32_t>& order) : order_(order) {}

  void visit(uint32_t size, size_t level = 0) {
    if (level == levels_.size()) levels_.emplace_back();
    if (size == 1) {
      levels_[level].child_count.push_back(0);
      levels_[level].leaf.push_back(order_[visited_++]);
      return;
    }
    const Parts parts = split_in_parts(size);
    levels_[level].child_count.push_back(static_cast<uint8_t>(parts.count));
    for (uint32_t i = 0; i < parts.count; ++i) visit(parts.size[i], level + 1);
  }

  TreeLayout joined() {
    TreeLayout layout;
    size_t nodes = 0;
    for (const TreeLayout& level : levels_) nodes += level.child_count.size();
    layout.child_count.reserve(nodes);
    layout.leaf.reserve(order_.size());
    for (TreeLayout& level : levels_) {
      layout.child_count.insert(layout.child_count.end(), level.child_count.begin(),
                                level.child_count.end());
      layout.leaf.insert(layout.leaf.end(), level.leaf.begin(), level.leaf.end());
      level = {};
    }
    return layout;
  }

 private:
  const std::vector<uint32_t>& order_;
  size_t visited_ = 0;
  std::vector<TreeLayout> levels_;
};

}  // namespace

TreeLayout kd_layout(const GaussianCloud& cloud, const std::array<double, 3>& origin,
                     Workers& workers) {
  if (cloud.size() == 0) return {};
  const std::vector<uint32_t> order = kd_order(cloud, origin, workers);
  LayoutWriter writer(order);
  writer.visit(static_cast<uint32_t>(order.size()));
  return writer.joined();
}

}  // namespace voyager
