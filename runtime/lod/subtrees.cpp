#include "runtime/lod/subtrees.h"

#include <algorithm>
#include <limits>

namespace voyager {
namespace {

std::pmr::vector<uint32_t> find_levels(const LodTree& tree, std::pmr::memory_resource* memory) {
  std::pmr::vector<uint32_t> begin(memory);
  if (tree.size() == 0) return begin;
  uint32_t first = 0, end = 1;
  while (first != end) {
    begin.push_back(first);
    uint32_t children = 0;
    for (uint32_t n = first; n < end; ++n) children += tree.records[n].child_count;
    first = end;
    end += children;
  }
  begin.push_back(first);
  return begin;
}

// Splits the nodes below one root into subtrees.
class Splitter {
 public:
  // levels: of the tier that the root starts, 1 to 3.
  Splitter(const LodTree& tree, uint32_t levels, std::pmr::vector<Subtree>& out)
      : tree_(tree), levels_(levels), out_(out) {}

  void split(uint32_t root) {
    current_ = {root, 0, 0, 1, 0, 0, Repeats::nothing};
    const uint32_t children = levels_ > 1 ? tree_.records[root].child_count : 0;
    for (uint32_t i = 0; i < children; ++i) add_child(tree_.first_child[root] + i);
    if (current_.child_count != 0 || !current_.repeats_root()) out_.push_back(current_);
  }

 private:
  uint32_t grandchildren_of(uint32_t child) const {
    return levels_ > 2 ? tree_.records[child].child_count : 0;
  }

  void add_child(uint32_t child) {
    const uint32_t grandchildren = grandchildren_of(child);
    if (current_.node_count() + 1 + grandchildren > kSubtreeNodes && current_.child_count != 0)
      close();
    if (2 + grandchildren > kSubtreeNodes) return add_in_runs(child, grandchildren);
    take(child, grandchildren == 0 ? 0 : tree_.first_child[child], grandchildren);
  }

  // No other child shares a subtree with a run.
  void add_in_runs(uint32_t child, uint32_t grandchildren) {
    constexpr uint32_t kRun = kSubtreeNodes - 2;
    for (uint32_t done = 0; done < grandchildren; done += kRun) {
      take(child, tree_.first_child[child] + done, std::min(kRun, grandchildren - done));
      if (done != 0) current_.repeated = Repeats::root_and_child;
      close();
    }
  }

  void take(uint32_t child, uint32_t first_grandchild, uint32_t grandchildren) {
    if (current_.child_count++ == 0) current_.first_child = child;
    if (current_.grandchild_count == 0) current_.first_grandchild = first_grandchild;
    current_.grandchild_count = static_cast<uint8_t>(current_.grandchild_count + grandchildren);
  }

  void close() {
    out_.push_back(current_);
    current_ = {current_.root, 0, 0, 1, 0, 0, Repeats::root};
  }

  const LodTree& tree_;
  uint32_t levels_;
  std::pmr::vector<Subtree>& out_;
  Subtree current_{};
};

// Of a tier of three levels: whether all that is below the root is there.
bool is_whole(const LodTree& tree, const Subtree& subtree) {
  return !subtree.repeats_root() && subtree.child_count == tree.records[subtree.root].child_count &&
         (subtree.child_count != 1 ||
          subtree.grandchild_count == tree.records[subtree.first_child].child_count);
}

// The nodes of `next` come behind those of `to` on each level.
void append(const Subtree& next, Subtree& to) {
  if (to.child_count == 0) to.first_child = next.first_child;
  if (to.grandchild_count == 0) to.first_grandchild = next.first_grandchild;
  const auto add = [](uint8_t& sum, uint8_t more) { sum = static_cast<uint8_t>(sum + more); };
  add(to.root_count, next.root_count);
  add(to.child_count, next.child_count);
  add(to.grandchild_count, next.grandchild_count);
}

// Fills the subtrees and the tiers, for a first tier of so many levels.
void split_tiers(const LodTree& tree, uint32_t first_tier_levels, Partition& partition) {
  const auto& levels = partition.level_begin;
  partition.first_tier_levels = first_tier_levels;
  partition.subtrees.clear();
  partition.tier_begin.clear();
  for (size_t level = 0; level + 1 < levels.size();) {
    const uint32_t height = level == 0 ? first_tier_levels : kTierLevels;
    partition.tier_begin.push_back(static_cast<uint32_t>(partition.subtrees.size()));
    split_tier(tree, height, levels[level], levels[level + 1], partition.subtrees);
    level += height;
  }
  partition.tier_begin.push_back(static_cast<uint32_t>(partition.subtrees.size()));
}

// The first tier that leaves the fewest subtrees; of several, that of most levels.
void split_into_fewest(const LodTree& tree, Partition& partition) {
  uint32_t best = 0;
  size_t fewest = 0;
  for (uint32_t levels = 1; levels <= kTierLevels; ++levels) {
    split_tiers(tree, levels, partition);
    if (best != 0 && partition.subtrees.size() > fewest) continue;
    best = levels;
    fewest = partition.subtrees.size();
  }
  if (best != kTierLevels) split_tiers(tree, best, partition);
}

// Where each tier begins, by the level of the roots.
void count_tiers(Partition& partition) {
  for (size_t tier = 1; tier < partition.tier_begin.size(); ++tier) {
    const size_t level = partition.first_tier_levels + (tier - 1) * kTierLevels;
    const uint32_t end =
        level < partition.level_begin.size() ? partition.level_begin[level] : kNoNode;
    const auto& subtrees = partition.subtrees;
    partition.tier_begin[tier] = static_cast<uint32_t>(
        std::partition_point(subtrees.begin(), subtrees.end(),
                             [&](const Subtree& subtree) { return subtree.root < end; }) -
        subtrees.begin());
  }
}

// The subtrees of a chunk, at least one.
EntryHull entry_hull(const LodTree& tree, std::span<const Subtree> subtrees) {
  const auto hull_above = [&](const Subtree& subtree) {
    const uint32_t parent = tree.parent[subtree.first_owned()];
    return parent == kNoNode ? hull_of_root(tree.records[0]) : hull_of(tree.records[parent]);
  };
  EntryHull hull = hull_above(subtrees.front());
  for (const Subtree& subtree : subtrees.subspan(1)) hull = join(hull, hull_above(subtree));
  return hull;
}

// Fills the partition's chunks, whose subtrees are then joined. Siblings share a subtree only where
// they share a chunk, so that chunks are as full as they would be without.
void pack_chunks(const LodTree& tree, Partition& partition, std::pmr::memory_resource* memory) {
  std::pmr::vector<uint32_t> sizes(memory);
  sizes.reserve(partition.subtrees.size());
  for (const Subtree& subtree : partition.subtrees)
    sizes.push_back(subtree.node_count() * static_cast<uint32_t>(sizeof(NodeRecord)));
  partition.chunk_begin = pack_runs(sizes, partition.chunk_bytes, memory);
  const std::span<const Subtree> all = partition.subtrees;
  for (size_t i = 0; i < partition.chunk_count(); ++i) {
    const uint32_t begin = partition.chunk_begin[i], end = partition.chunk_begin[i + 1];
    partition.chunk_hull.push_back(entry_hull(tree, all.subspan(begin, end - begin)));
  }
  join_siblings(tree, partition.chunk_begin, partition.subtrees);
  count_tiers(partition);
}

// Of one chunk. Returns how many are left, from the first place on.
size_t join_chunk(const LodTree& tree, std::span<Subtree> subtrees) {
  SiblingRule rule;
  size_t used = 0;
  for (size_t i = 0; i < subtrees.size(); ++i) {
    const Subtree next = subtrees[i];
    bool shares = false;
    if (!is_whole(tree, next)) {
      rule.start();
    } else {
      const uint32_t parent = tree.parent[next.root];
      const bool sibling =
          used != 0 && parent != kNoNode && parent == tree.parent[subtrees[used - 1].root];
      shares = rule.shares(next.node_count(), sibling, next.grandchild_count != 0);
    }
    if (shares)
      append(next, subtrees[used - 1]);
    else
      subtrees[used++] = next;
  }
  return used;
}

}  // namespace

EntryHull hull_of(const NodeRecord& parent) {
  return {parent.box_min, parent.extent, parent.box_max};
}

EntryHull hull_of_root(const NodeRecord& root) {
  return {root.box_min, std::numeric_limits<float>::infinity(), root.box_max};
}

EntryHull join(const EntryHull& a, const EntryHull& b) {
  EntryHull hull = a;
  for (int axis = 0; axis < 3; ++axis) {
    hull.box_min[axis] = std::min(a.box_min[axis], b.box_min[axis]);
    hull.box_max[axis] = std::max(a.box_max[axis], b.box_max[axis]);
  }
  hull.extent = std::max(a.extent, b.extent);
  return hull;
}

std::pmr::vector<uint32_t> pack_runs(std::span<const uint32_t> sizes, uint32_t limit,
                                     std::pmr::memory_resource* memory) {
  std::pmr::vector<uint32_t> begin(memory);
  uint64_t used = 0;
  for (size_t i = 0; i < sizes.size(); ++i) {
    if (i == 0 || used + sizes[i] > limit) {
      begin.push_back(static_cast<uint32_t>(i));
      used = 0;
    }
    used += sizes[i];
  }
  begin.push_back(static_cast<uint32_t>(sizes.size()));
  return begin;
}

void join_siblings(const LodTree& tree, std::span<uint32_t> chunk_begin,
                   std::pmr::vector<Subtree>& subtrees) {
  const std::span<Subtree> all = subtrees;
  uint32_t used = 0;
  for (size_t i = 0; i + 1 < chunk_begin.size(); ++i) {
    const auto apart = all.subspan(chunk_begin[i], chunk_begin[i + 1] - chunk_begin[i]);
    const auto joined = apart.first(join_chunk(tree, apart));
    chunk_begin[i] = used;
    for (const Subtree& subtree : joined) all[used++] = subtree;
  }
  chunk_begin.back() = used;
  subtrees.resize(used);
}

void split_tier(const LodTree& tree, uint32_t levels, uint32_t begin, uint32_t end,
                std::pmr::vector<Subtree>& out) {
  Splitter splitter(tree, levels, out);
  for (uint32_t root = begin; root < end; ++root) splitter.split(root);
}

Partition partition_tree(const LodTree& tree, uint32_t chunk_bytes,
                         std::pmr::memory_resource* memory) {
  Partition partition(memory);
  partition.chunk_bytes = chunk_bytes;
  partition.level_begin = find_levels(tree, memory);
  if (tree.size() == 0) return partition;
  split_into_fewest(tree, partition);
  pack_chunks(tree, partition, memory);
  return partition;
}

}  // namespace voyager
