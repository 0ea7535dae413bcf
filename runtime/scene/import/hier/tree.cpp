#include "runtime/scene/import/hier/tree.h"

#include <algorithm>
#include <bitset>
#include <memory>

#include "runtime/scene/import/refuse.h"

namespace voyager::hier {
namespace {

constexpr size_t kBlock = 65536;  // nodes read at a time: memory grows as they arrive

std::vector<HierNode> read_all_nodes(const File& file) {
  std::vector<HierNode> nodes;
  while (nodes.size() < file.nodes()) {
    const auto count = std::min<size_t>(kBlock, file.nodes() - nodes.size());
    const std::vector<HierNode> block = file.read_nodes(nodes.size(), count);
    nodes.insert(nodes.end(), block.begin(), block.end());
  }
  return nodes;
}

// Which Gaussians a node has. What the file's count says is believed as nodes come: a page is there
// from its first Gaussian on.
class Taken {
 public:
  explicit Taken(uint64_t gaussians) : pages_((gaussians + kPage - 1) / kPage) {}
  // False where it was taken before.
  bool take(uint64_t gaussian) {
    std::unique_ptr<std::bitset<kPage>>& page = pages_[gaussian / kPage];
    if (!page) page = std::make_unique<std::bitset<kPage>>();
    if (page->test(gaussian % kPage)) return false;
    page->set(gaussian % kPage);
    ++count_;
    return true;
  }
  uint64_t count() const { return count_; }

 private:
  static constexpr uint64_t kPage = 4096;
  std::vector<std::unique_ptr<std::bitset<kPage>>> pages_;
  uint64_t count_ = 0;
};

class Walk {
 public:
  explicit Walk(const File& file)
      : file_(file), nodes_(read_all_nodes(file)), taken_(file.gaussians()) {}

  Tree run() {
    if (nodes_.empty()) return {};
    node_met_.resize(nodes_.size());
    meet(0, -1);
    for (size_t i = 0; i < tree_.file_node.size(); ++i) visit(tree_.file_node[i]);
    if (tree_.file_node.size() != nodes_.size()) refuse_unreached();
    tree_.unused = file_.gaussians() - taken_.count();
    return std::move(tree_);
  }

 private:
  [[noreturn]] void refuse_node(size_t node, const char* field, const std::string& found,
                                const std::string& expected) const {
    refuse(file_.name(), file_.offset_of_node(node), "node " + std::to_string(node) + ", " + field,
           found, expected);
  }

  void meet(size_t node, int64_t parent) {
    if (node_met_[node])
      refuse_node(node, "parent", "a second node that has it as a child", "one parent for each");
    if (nodes_[node].parent != parent)
      refuse_node(node, "parent", std::to_string(nodes_[node].parent), std::to_string(parent));
    node_met_[node] = true;
    tree_.file_node.push_back(static_cast<uint32_t>(node));
  }

  void visit(size_t node) {
    const HierNode& n = nodes_[node];
    take_gaussians(node, n);
    const int64_t begin = n.start_children, count = n.count_children;
    if (count < 0 ||
        (count > 0 && (begin < 1 || begin + count > static_cast<int64_t>(nodes_.size()))))
      refuse_node(node, "children",
                  std::to_string(count) + " from node " + std::to_string(begin) + " on",
                  "nodes 1 to " + std::to_string(nodes_.size() - 1));
    if (n.depth < 0 || (n.depth == 0 && count > 0))
      refuse_node(node, "depth", std::to_string(n.depth),
                  count > 0 ? "1 or more of a node with children" : "0 or more");
    tree_.childless += n.depth > 0 && count == 0;
    tree_.child_count.push_back(static_cast<uint32_t>(count));
    for (int64_t child = begin; child < begin + count; ++child)
      meet(static_cast<size_t>(child), static_cast<int64_t>(node));
  }

  // A leaf has one. An inner node draws the first of its merged ones. No Gaussian is of two nodes,
  // so that all of them are no more than the file's.
  void take_gaussians(size_t node, const HierNode& n) {
    const bool leaf = n.depth == 0;
    if (leaf ? n.count_leafs != 1 || n.count_merged != 0 : n.count_leafs != 0 || n.count_merged < 1)
      refuse_node(node, "Gaussians",
                  std::to_string(n.count_leafs) + " of leaves and " +
                      std::to_string(n.count_merged) + " merged",
                  leaf ? "1 and 0 of a leaf" : "0 and 1 or more of an inner node");
    const int64_t count = int64_t{n.count_leafs} + n.count_merged;
    if (n.start < 0 || n.start + count > int64_t{file_.gaussians()})
      refuse_node(node, "start",
                  std::to_string(n.start) + " with " + std::to_string(count) + " Gaussians",
                  "a range of the file's " + std::to_string(file_.gaussians()));
    for (int64_t i = n.start; i < n.start + count; ++i)
      if (!taken_.take(static_cast<uint64_t>(i)))
        refuse_node(node, "Gaussians", std::to_string(i) + ", which another node has",
                    "Gaussians of its own");
    if (count > 1)
      tree_.further.push_back(
          {static_cast<uint32_t>(tree_.gaussian.size()), static_cast<uint32_t>(count - 1)});
    tree_.gaussian.push_back(static_cast<uint32_t>(n.start));
  }

  [[noreturn]] void refuse_unreached() const {
    const auto at = std::find(node_met_.begin(), node_met_.end(), false);
    refuse_node(static_cast<size_t>(at - node_met_.begin()), "parent",
                "no node that has it as a child", "every node but the first to be a child");
  }

  const File& file_;
  const std::vector<HierNode> nodes_;
  std::vector<bool> node_met_;
  Taken taken_;
  Tree tree_;
};

}  // namespace

Tree read_tree(const File& file) {
  return Walk(file).run();
}

std::vector<uint32_t> leaf_gaussians(const Tree& tree) {
  std::vector<uint32_t> leaves;
  for (size_t n = 0; n < tree.child_count.size(); ++n)
    if (tree.child_count[n] == 0) leaves.push_back(tree.gaussian[n]);
  std::sort(leaves.begin(), leaves.end());
  return leaves;
}

}  // namespace voyager::hier
