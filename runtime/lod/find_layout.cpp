#include "runtime/lod/find_layout.h"

#include <mutex>

#include "runtime/lod/cluster.h"
#include "runtime/lod/exposure.h"
#include "runtime/lod/kd_order.h"
#include "runtime/lod/shape.h"

namespace voyager {
namespace {

// The blocks, in kd order.
struct Clusters {
  std::vector<uint8_t> footprint;      // level by Gaussian; none: 0
  std::vector<ExposureCode> exposure;  // by Gaussian; this and trees of a clustered tree alone
  std::vector<ClusterTree> trees;
};

// Visits nodes depth-first, as the order has their Gaussians: the nodes of one level are
// then met in the order that they have breadth-first.
class LayoutWriter {
 public:
  LayoutWriter(const std::vector<uint32_t>& order, const KdRule& rule, const Clusters& clusters)
      : order_(order), rule_(rule), clusters_(clusters) {}

  void visit(uint32_t size, size_t level = 0) {
    if (size <= rule_.block) return visit_block(size, level);
    const Parts parts = split_in_parts(size, rule_);
    add_node(parts.count, level);
    for (uint32_t i = 0; i < parts.count; ++i) visit(parts.size[i], level + 1);
  }

  TreeLayout joined() {
    TreeLayout layout;
    size_t nodes = 0;
    for (const TreeLayout& level : levels_) nodes += level.child_count.size();
    layout.child_count.reserve(nodes);
    layout.leaf.reserve(order_.size());
    for (TreeLayout& level : levels_) {
      append(level.child_count, layout.child_count);
      append(level.leaf, layout.leaf);
      append(level.exposure, layout.exposure);
      append(level.footprint, layout.footprint);
      level = {};
    }
    return layout;
  }

 private:
  template <class T>
  static void append(const std::vector<T>& from, std::vector<T>& to) {
    to.insert(to.end(), from.begin(), from.end());
  }

  void visit_block(uint32_t size, size_t level) {
    if (clusters_.trees.empty()) return add_leaf(order_[visited_++], level);
    const ClusterTree& tree = clusters_.trees[block_++];
    visit_cluster(tree, static_cast<uint32_t>(tree.nodes.size() - 1), level);
    visited_ += size;
  }

  void visit_cluster(const ClusterTree& tree, uint32_t index, size_t level) {
    const ClusterTree::Node& node = tree.nodes[index];
    if (node.children == 0) return add_leaf(order_[visited_ + index], level);
    add_node(node.children, level);
    for (uint32_t i = 0; i < node.children; ++i) visit_cluster(tree, node.child[i], level + 1);
  }

  TreeLayout& at(size_t level) {
    if (level == levels_.size()) levels_.emplace_back();
    return levels_[level];
  }

  void add_node(uint32_t children, size_t level) {
    at(level).child_count.push_back(static_cast<uint8_t>(children));
  }

  void add_leaf(uint32_t gaussian, size_t level) {
    add_node(0, level);
    at(level).leaf.push_back(gaussian);
    if (!clusters_.exposure.empty()) at(level).exposure.push_back(clusters_.exposure[gaussian]);
    if (!clusters_.footprint.empty()) at(level).footprint.push_back(clusters_.footprint[gaussian]);
  }

  const std::vector<uint32_t>& order_;
  const KdRule& rule_;
  const Clusters& clusters_;
  size_t visited_ = 0, block_ = 0;
  std::vector<TreeLayout> levels_;
};

// By Gaussian.
std::vector<uint8_t> find_footprints(const GaussianCloud& cloud, const std::vector<uint32_t>& order,
                                     const TreeRule& rule, const BlockFootprints& footprints,
                                     Workers& workers) {
  const auto size = static_cast<uint32_t>(order.size());
  std::vector<uint8_t> levels(size);
  const std::vector<Range> blocks = parts_of(size, rule.block, kd_rule(rule));
  workers.for_blocks(blocks.size(), 1, [&](size_t i, size_t) {
    const auto leaves = std::span(order).subspan(blocks[i].begin, blocks[i].size);
    const uint8_t level = footprint_level(cloud, leaves, footprints);
    for (const uint32_t leaf : leaves) levels[leaf] = level;
  });
  return levels;
}

void find_clusters(const GaussianCloud& cloud, const std::array<double, 3>& origin,
                   const std::vector<uint32_t>& order, const TreeRule& rule, Workers& workers,
                   const Progress& progress, Clusters& clusters) {
  const auto size = static_cast<uint32_t>(order.size());
  const KdRule kd = kd_rule(rule);
  std::mutex telling;
  uint64_t done = 0;
  const auto tell = [&](uint32_t gaussians) {
    const std::lock_guard lock(telling);
    report(progress, "clustering", done += gaussians, uint64_t{2} * size);
  };
  const auto for_parts = [&](uint32_t most, const auto& body) {
    const std::vector<Range> parts = parts_of(size, most, kd);
    workers.for_blocks(parts.size(), 1, [&](size_t i, size_t) {
      body(i, std::span(order).subspan(parts[i].begin, parts[i].size));
      tell(parts[i].size);
    });
  };
  clusters.exposure.resize(size);
  for_parts(rule.exposure_block, [&](size_t, std::span<const uint32_t> leaves) {
    find_exposure(cloud, origin, leaves, clusters.exposure);
  });
  clusters.trees.resize(parts_of(size, rule.block, kd).size());
  for_parts(rule.block, [&](size_t i, std::span<const uint32_t> leaves) {
    const int level = clusters.footprint.empty() ? 0 : clusters.footprint[leaves.front()];
    clusters.trees[i] = cluster(cloud, origin, leaves, clusters.exposure, level);
  });
}

}  // namespace

TreeLayout find_layout(const GaussianCloud& cloud, const std::array<double, 3>& origin,
                       const TreeRule& rule, Workers& workers, const Progress& progress,
                       const BlockFootprints& footprints) {
  if (cloud.size() == 0) return {};
  const KdRule kd = kd_rule(rule);
  report(progress, "splitting", 0, cloud.size());
  const std::vector<uint32_t> order = kd_order(cloud, origin, kd, workers);
  report(progress, "splitting", cloud.size(), cloud.size());
  Clusters clusters;
  if (cloud.native.levels > 1)
    clusters.footprint = find_footprints(cloud, order, rule, footprints, workers);
  if (rule.kind == TreeKind::clustered)
    find_clusters(cloud, origin, order, rule, workers, progress, clusters);
  LayoutWriter writer(order, kd, clusters);
  writer.visit(static_cast<uint32_t>(order.size()));
  return writer.joined();
}

}  // namespace voyager
