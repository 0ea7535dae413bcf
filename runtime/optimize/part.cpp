#include "runtime/optimize/part.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "runtime/scene/sanitise.h"

namespace voyager {
namespace {

// Nodes around the part are at first no larger than this share of their distance, a pixel of a
// training picture. The share grows by kCoarser until they fit.
constexpr double kFinestAround = 1.0 / 175, kCoarser = 1.4142135623730951;
// Distances count at least this share of the part's diagonal.
constexpr double kLeastAway = 0.02;

std::vector<uint64_t> leaves_below(const LodTree& tree) {
  std::vector<uint64_t> count(tree.size(), 0);
  for (auto n = static_cast<uint32_t>(tree.size()); n-- > 0;) {
    if (tree.is_leaf(n)) count[n] = 1;
    if (n != 0) count[tree.parent[n]] += count[n];
  }
  return count;
}

struct Hull {
  Vec3f low, high;

  void add(const NodeRecord& r) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], r.box_min[axis]);
      high[axis] = std::max(high[axis], r.box_max[axis]);
    }
  }
  double diagonal() const {
    const Vec3f d = high - low;
    return std::hypot(double{d.x}, double{d.y}, double{d.z});
  }
  double distance(const NodeRecord& r) const {
    double square = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double away = std::max({0.0, double{r.box_min[axis]} - double{high[axis]},
                                    double{low[axis]} - double{r.box_max[axis]}});
      square += away * away;
    }
    return std::sqrt(square);
  }
};

Hull hull_of(const LodTree& tree, uint32_t first, uint32_t count) {
  Hull hull{tree.records[first].box_min, tree.records[first].box_max};
  for (uint32_t n = first; n < first + count; ++n) hull.add(tree.records[n]);
  return hull;
}

// The coarsest nodes that cover all but the part, each no larger than `finest` times its distance.
// Returns none if they are more than `most`.
std::vector<uint32_t> around(const LodTree& tree, const PartRoots& roots, double finest,
                             uint64_t most) {
  const Hull hull = hull_of(tree, roots.first, roots.count);
  const double least = kLeastAway * hull.diagonal();
  std::vector<bool> above(tree.size(), false);
  for (uint32_t n = roots.first; n != 0;) above[n = tree.parent[n]] = true;
  std::vector<uint32_t> found, open{0};
  while (!open.empty()) {
    const uint32_t n = open.back();
    open.pop_back();
    if (n >= roots.first && n < roots.first + roots.count) continue;
    const NodeRecord& r = tree.records[n];
    const bool fine = double{r.extent} <= finest * (hull.distance(r) + least);
    if (!above[n] && (tree.is_leaf(n) || fine)) {
      found.push_back(n);
      if (found.size() > most) return {};
      continue;
    }
    for (uint32_t i = 0; i < r.child_count; ++i) open.push_back(tree.first_child[n] + i);
  }
  std::sort(found.begin(), found.end());
  return found;
}

// The finest cover with at most `most` nodes, else the coarsest one.
std::vector<uint32_t> finest_around(const LodTree& tree, const PartRoots& roots, uint64_t most) {
  if (roots.first == 0) return {};
  for (double finest = kFinestAround; finest < 1e6; finest *= kCoarser) {
    std::vector<uint32_t> found = around(tree, roots, finest, most);
    if (!found.empty()) return found;
  }
  return around(tree, roots, std::numeric_limits<double>::infinity(), tree.size());
}

// Builds the part's scene from nodes of the whole's.
class Taking {
 public:
  explicit Taking(const BakedScene& whole) : whole_(whole) {
    BakedScene& scene = part_.scene;
    scene.origin = whole.origin;
    scene.kind = whole.kind;
    scene.tree.blend_share = whole.tree.blend_share;
    for (const auto& [to, from] :
         {std::pair{&scene.leaves, &whole.leaves}, std::pair{&scene.merged, &whole.merged}}) {
      to->sh_degree = from->sh_degree;
      to->left_out_bands = from->left_out_bands;
      to->native = from->native;
      to->origin = from->origin;
    }
  }

  // Adds a root that only holds others together. Its size is infinite, so no cut has it.
  void add_root(const std::vector<uint32_t>& children) {
    NodeRecord root = whole_.tree.records[0];
    root.extent = std::numeric_limits<float>::infinity();
    add(root, kNoNode, kNoNode);
    add_merged(0);
    add_children(0, children);
  }
  // Adds all descendants of the nodes so far, down to leaves and to nodes that become leaves.
  void add_below(const std::vector<bool>& becomes_leaf) {
    const LodTree& tree = whole_.tree;
    if (part_.whole.empty()) add(tree.records[0], kNoNode, 0);
    for (uint32_t p = 0; p < part_.whole.size(); ++p) {
      const uint32_t n = part_.whole[p];
      if (n == kNoNode || tree.is_leaf(n)) continue;
      if (becomes_leaf[n]) {
        part_.scene.tree.records[p].child_count = 0;
        part_.scene.tree.records[p].extent = 0;
        continue;
      }
      add_merged(p);
      std::vector<uint32_t> children(tree.records[n].child_count);
      for (uint32_t i = 0; i < children.size(); ++i) children[i] = tree.first_child[n] + i;
      add_children(p, children);
    }
  }
  // own[n]: whether views look at node n of the whole.
  ScenePart finish(const std::vector<bool>& own) {
    for (const bool looked_at : {true, false}) {
      for (uint32_t p = 0; p < part_.whole.size(); ++p)
        if (part_.scene.tree.is_leaf(p) && own[part_.whole[p]] == looked_at) add_leaf(p);
      if (looked_at) part_.own_leaves = part_.scene.leaves.size();
    }
    return std::move(part_);
  }

 private:
  void add(const NodeRecord& record, uint32_t parent, uint32_t node) {
    LodTree& tree = part_.scene.tree;
    tree.records.push_back(record);
    tree.parent.push_back(parent);
    tree.first_child.push_back(0);
    part_.scene.gaussian.push_back(0);
    part_.scene.node_code.push_back(whole_.node_code[node == kNoNode ? 0 : node]);
    part_.whole.push_back(node);
  }

  void add_children(uint32_t parent, const std::vector<uint32_t>& nodes) {
    LodTree& tree = part_.scene.tree;
    tree.first_child[parent] = static_cast<uint32_t>(tree.size());
    tree.records[parent].child_count = static_cast<uint32_t>(nodes.size());
    for (const uint32_t n : nodes) add(whole_.tree.records[n], parent, n);
  }

  static void push(const GaussianCloud& from, size_t i, GaussianCloud& to) {
    const auto coefficients = static_cast<size_t>(from.coefficients()) * 3;
    const auto copy = [i](const auto& source, auto& into, size_t width) {
      into.insert(into.end(), source.begin() + static_cast<std::ptrdiff_t>(i * width),
                  source.begin() + static_cast<std::ptrdiff_t>((i + 1) * width));
    };
    copy(from.position, to.position, 3);
    copy(from.log_scale, to.log_scale, 3);
    copy(from.rotation, to.rotation, 4);
    copy(from.opacity, to.opacity, 1);
    copy(from.sh, to.sh, coefficients);
  }

  void add_merged(uint32_t p) {
    const uint32_t n = part_.whole[p] == kNoNode ? 0 : part_.whole[p];
    part_.scene.gaussian[p] = static_cast<uint32_t>(part_.scene.merged.size());
    push(whole_.merged, whole_.gaussian[n], part_.scene.merged);
  }

  // A merged node's opacity is linear, and may be above 1; a leaf's is a logit.
  void add_leaf(uint32_t p) {
    const uint32_t n = part_.whole[p];
    GaussianCloud& leaves = part_.scene.leaves;
    part_.scene.gaussian[p] = static_cast<uint32_t>(leaves.size());
    const bool merged = !whole_.tree.is_leaf(n);
    push(merged ? whole_.merged : whole_.leaves, whole_.gaussian[n], leaves);
    if (!merged) return;
    for (size_t axis = 0; axis < 3; ++axis) {
      float& word = leaves.position[leaves.position.size() - 3 + axis];
      word = static_cast<float>((double{word} + whole_.origin[axis]) - leaves.origin[axis]);
    }
    float& opacity = leaves.opacity.back();
    opacity = std::clamp(logit(std::min(opacity, 1.0f - 0x1p-24f)), -kMaxLogit, kMaxLogit);
  }

  const BakedScene& whole_;
  ScenePart part_;
};

double median_extent(const LodTree& tree, const std::vector<uint32_t>& nodes) {
  std::vector<double> extents;
  for (const uint32_t n : nodes)
    if (!tree.is_leaf(n)) extents.push_back(tree.records[n].extent);
  if (extents.empty()) return 0;
  const auto middle = extents.begin() + static_cast<std::ptrdiff_t>(extents.size() / 2);
  std::nth_element(extents.begin(), middle, extents.end());
  return *middle;
}

}  // namespace

std::vector<PartRoots> part_roots(const LodTree& tree, uint64_t most_leaves) {
  const std::vector<uint64_t> leaves = leaves_below(tree);
  std::vector<PartRoots> parts;
  if (leaves[0] <= most_leaves) return {{0, 1, leaves[0]}};
  PartRoots run{0, 0, 0};
  bool merges = false;
  const auto end_run = [&] {
    if (merges) parts.push_back(run);
    run = {0, 0, 0};
    merges = false;
  };
  for (uint32_t n = 1; n < tree.size(); ++n) {
    const bool root = leaves[n] <= most_leaves && leaves[tree.parent[n]] > most_leaves;
    if (!root) continue;
    const bool goes_on = run.count != 0 && run.first + run.count == n &&
                         tree.parent[run.first] == tree.parent[n] &&
                         run.leaves + leaves[n] <= most_leaves;
    if (!goes_on) {
      end_run();
      run.first = n;
    }
    ++run.count;
    run.leaves += leaves[n];
    merges |= !tree.is_leaf(n);
  }
  end_run();
  return parts;
}

ScenePart take_part(const BakedScene& whole, const PartRoots& roots, uint64_t most_around) {
  const LodTree& tree = whole.tree;
  const std::vector<uint32_t> outside = finest_around(tree, roots, most_around);
  std::vector<bool> stands(tree.size(), false), own(tree.size(), false);
  for (const uint32_t n : outside) stands[n] = true;
  for (uint32_t n = roots.first; n < tree.size(); ++n) {
    const bool root = n - roots.first < roots.count;
    own[n] = root || (n != 0 && own[tree.parent[n]]);
  }
  std::vector<uint32_t> children(roots.count);
  for (uint32_t i = 0; i < roots.count; ++i) children[i] = roots.first + i;
  children.insert(children.end(), outside.begin(), outside.end());
  Taking taking(whole);
  taking.add_root(children);
  taking.add_below(stands);
  ScenePart part = taking.finish(own);
  for (uint32_t n = roots.first; n < roots.first + roots.count; ++n)
    if (std::isfinite(tree.records[n].extent))
      part.largest = std::max(part.largest, double{tree.records[n].extent});
  return part;
}

ScenePart take_top(const BakedScene& whole, uint64_t most_leaves) {
  const LodTree& tree = whole.tree;
  // The coarsest is opened first; of equal ones that with the lesser id.
  const auto finer = [&](uint32_t a, uint32_t b) {
    const float x = tree.records[a].extent, y = tree.records[b].extent;
    return x != y ? x < y : a > b;
  };
  std::priority_queue<uint32_t, std::vector<uint32_t>, decltype(finer)> open(finer);
  std::vector<uint32_t> stand;
  open.push(0);
  while (!open.empty() && open.size() + stand.size() < most_leaves) {
    const uint32_t n = open.top();
    open.pop();
    if (tree.is_leaf(n)) stand.push_back(n);
    for (uint32_t i = 0; i < tree.records[n].child_count; ++i) open.push(tree.first_child[n] + i);
  }
  for (; !open.empty(); open.pop()) stand.push_back(open.top());
  std::vector<bool> stands(tree.size(), false);
  for (const uint32_t n : stand) stands[n] = true;
  Taking taking(whole);
  taking.add_below(stands);
  ScenePart part = taking.finish(std::vector<bool>(tree.size(), true));
  part.leaf_size = median_extent(tree, stand);
  return part;
}

void give_back(const ScenePart& part, const std::vector<bool>& kept, BakedScene& whole) {
  const auto coefficients = static_cast<size_t>(whole.merged.coefficients()) * 3;
  const GaussianCloud& from = part.scene.merged;
  GaussianCloud& to = whole.merged;
  for (uint32_t p = 0; p < part.whole.size(); ++p) {
    const uint32_t n = part.whole[p];
    if (n == kNoNode || kept[n] || part.scene.tree.is_leaf(p)) continue;
    const size_t i = part.scene.gaussian[p], k = whole.gaussian[n];
    std::copy_n(&from.position[3 * i], 3, &to.position[3 * k]);
    std::copy_n(&from.log_scale[3 * i], 3, &to.log_scale[3 * k]);
    std::copy_n(&from.rotation[4 * i], 4, &to.rotation[4 * k]);
    to.opacity[k] = from.opacity[i];
    std::copy_n(&from.sh[i * coefficients], coefficients, &to.sh[k * coefficients]);
    whole.tree.records[n].extent = part.scene.tree.records[p].extent;
  }
}

}  // namespace voyager
