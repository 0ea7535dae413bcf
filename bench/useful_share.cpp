// How much of what a cut touches it needs: nodes that are reached, and seen, over all nodes of the
// chunks that hold them; for the file's chunks, and for other orders of the same families.
//   useful_share SCENE.voy CAMERAS.json WxH TAU...
// Means over the cameras. A node is reached if its parent is refined, and seen if its box, a leaf's
// its parent's, is in the frustum.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include "runtime/base/open_source.h"
#include "runtime/frame/scene.h"
#include "runtime/frame/whole_tree.h"
#include "runtime/math/morton.h"
#include "runtime/stream/viewer.h"
#include "tools/cameras.h"
#include "tools/search_bench.h"

namespace {

using namespace voyager;

using Pages = std::vector<uint32_t>;  // by node

Pages chunks_of(const Scene& scene, size_t nodes) {
  Pages pages(nodes);
  const Partition& partition = scene.partition;
  for (uint32_t chunk = 0; chunk < partition.chunk_count(); ++chunk)
    for (uint32_t s = partition.chunk_begin[chunk]; s < partition.chunk_begin[chunk + 1]; ++s) {
      const Subtree& subtree = partition.subtrees[s];
      for (uint32_t slot = subtree.first_owned_slot(); slot < subtree.node_count(); ++slot)
        pages[subtree.node(slot)] = chunk;
    }
  return pages;
}

// Families, which are their parents' numbers, one after another in pages of at most so many nodes.
Pages packed(const LodTree& tree, const std::vector<uint32_t>& families, uint32_t most) {
  Pages pages(tree.size());
  uint32_t page = 0, used = 1;  // the root
  for (const uint32_t parent : families) {
    const uint32_t count = tree.records[parent].child_count;
    if (used + count > most) ++page, used = 0;
    used += count;
    for (uint32_t k = 0; k < count; ++k) pages[tree.first_child[parent] + k] = page;
  }
  return pages;
}

std::vector<uint32_t> parents_of(const LodTree& tree) {
  std::vector<uint32_t> parents;
  for (uint32_t n = 0; n < tree.size(); ++n)
    if (!tree.is_leaf(n)) parents.push_back(n);
  return parents;
}

std::vector<uint32_t> depth_first(const LodTree& tree) {
  std::vector<uint32_t> order, open = {0};
  while (!open.empty()) {
    const uint32_t n = open.back();
    open.pop_back();
    if (tree.is_leaf(n)) continue;
    order.push_back(n);
    for (uint32_t k = tree.records[n].child_count; k-- > 0;)
      open.push_back(tree.first_child[n] + k);
  }
  return order;
}

// Where a node is, large ones before small ones by classes of sizes that are `octaves` wide.
class SizeAndPlace {
 public:
  SizeAndPlace(const LodTree& tree, double octaves) : tree_(tree), octaves_(octaves) {
    const NodeRecord& root = tree.records[0];
    const Vec3f side = root.box_max - root.box_min;
    least_ = root.box_min, widest_ = std::max({side.x, side.y, side.z, 1e-6f});
  }
  using Key = std::pair<double, uint64_t>;
  Key operator()(uint32_t n) const {
    const NodeRecord& r = tree_.records[n];
    const auto cell = [&](int axis) {
      const float middle = (r.box_min[axis] + r.box_max[axis]) / 2 - least_[axis];
      return static_cast<uint32_t>(std::clamp(middle / widest_, 0.0f, 1.0f) * 0x1fffff);
    };
    const double size = std::clamp(double{r.extent}, 1e-9, 1e9);
    return {-std::floor(std::log2(size) / octaves_), morton_code(cell(0), cell(1), cell(2))};
  }

 private:
  const LodTree& tree_;
  double octaves_;
  Vec3f least_;
  float widest_;
};

std::vector<uint32_t> by_size(const LodTree& tree, double octaves) {
  const SizeAndPlace key(tree, octaves);
  std::vector<uint32_t> parents = parents_of(tree);
  std::vector<SizeAndPlace::Key> keys(tree.size());
  for (const uint32_t n : parents) keys[n] = key(n);
  std::stable_sort(parents.begin(), parents.end(),
                   [&](uint32_t a, uint32_t b) { return keys[a] < keys[b]; });
  return parents;
}

// The file's subtrees, whole, in pages of at most so many records: by the node that each hangs
// from, and first by tier if `tiers`.
Pages packed_subtrees(const Scene& scene, const LodTree& tree, double octaves, bool tiers,
                      uint32_t most) {
  const Partition& partition = scene.partition;
  const SizeAndPlace key(tree, octaves);
  std::vector<uint32_t> parent(tree.size(), 0);
  for (const uint32_t n : parents_of(tree))
    for (uint32_t k = 0; k < tree.records[n].child_count; ++k) parent[tree.first_child[n] + k] = n;
  std::vector<std::tuple<size_t, SizeAndPlace::Key, uint32_t>> order;
  for (uint32_t s = 0, tier = 0; s < partition.subtrees.size(); ++s) {
    while (partition.tier_begin[tier + 1] <= s) ++tier;
    order.emplace_back(tiers ? tier : 0, key(parent[partition.subtrees[s].first_owned()]), s);
  }
  std::sort(order.begin(), order.end());
  Pages pages(tree.size());
  uint32_t page = 0, used = 0;
  for (const auto& [tier, at, s] : order) {
    const Subtree& subtree = partition.subtrees[s];
    if (used + subtree.node_count() > most) ++page, used = 0;
    used += subtree.node_count();
    for (uint32_t slot = subtree.first_owned_slot(); slot < subtree.node_count(); ++slot)
      pages[subtree.node(slot)] = page;
  }
  return pages;
}

// A node's children and grandchildren together, for every other level of the tree.
Pages packed_twos(const LodTree& tree, double octaves, uint32_t most) {
  const SizeAndPlace key(tree, octaves);
  std::vector<uint8_t> level(tree.size(), 0);
  std::vector<std::pair<SizeAndPlace::Key, uint32_t>> order;
  for (uint32_t n = 0; n < tree.size(); ++n) {
    for (uint32_t k = 0; k < tree.records[n].child_count; ++k)
      level[tree.first_child[n] + k] = level[n] + 1;
    if (!tree.is_leaf(n) && level[n] % 2 == 0) order.emplace_back(key(n), n);
  }
  std::sort(order.begin(), order.end());
  Pages pages(tree.size());
  uint32_t page = 0, used = 1;
  for (const auto& [at, n] : order) {
    const uint32_t first = tree.first_child[n], count = tree.records[n].child_count;
    uint32_t all = count;
    for (uint32_t k = first; k < first + count; ++k) all += tree.records[k].child_count;
    if (used + all > most) ++page, used = 0;
    used += all;
    for (uint32_t k = first; k < first + count; ++k) {
      pages[k] = page;
      for (uint32_t j = 0; j < tree.records[k].child_count; ++j)
        pages[tree.first_child[k] + j] = page;
    }
  }
  return pages;
}

Wedge wedge_of(const tools::Camera& camera, const Vec3f& eye) {
  const double x = camera.pose.orientation[0], y = camera.pose.orientation[1],
               z = camera.pose.orientation[2], w = camera.pose.orientation[3];
  const Vec3d right{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
      up{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
      back{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
  const Vec3d forward = -1.0 * back, down = -1.0 * up;
  const auto unit = [](const Vec3d& v) {
    const Vec3d n = (1 / std::sqrt(dot(v, v))) * v;
    return Vec3f{static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
  };
  const double left = -camera.cx / camera.fx, to_right = (camera.width - camera.cx) / camera.fx,
               above = -camera.cy / camera.fy, below = (camera.height - camera.cy) / camera.fy;
  return {eye,
          {unit(right - left * forward), unit(to_right * forward - right),
           unit(down - above * forward), unit(below * forward - down), unit(forward)}};
}

struct Touched {
  double nodes = 0, pages = 0, held = 0;  // held: by those pages
};

Touched touched(const Pages& pages, const std::vector<uint32_t>& sizes,
                const std::vector<bool>& needed) {
  std::vector<bool> page(sizes.size());
  Touched sum;
  for (size_t n = 0; n < needed.size(); ++n) {
    if (!needed[n]) continue;
    ++sum.nodes;
    if (page[pages[n]]) continue;
    page[pages[n]] = true;
    ++sum.pages;
    sum.held += sizes[pages[n]];
  }
  return sum;
}

}  // namespace

int main(int argc, char** argv) try {
  unsigned width = 0, height = 0;
  if (argc < 5 || std::sscanf(argv[3], "%ux%u", &width, &height) != 2) {
    fmt::print(stderr, "useful_share SCENE.voy CAMERAS.json WxH TAU...\n");
    return 1;
  }
  Workers workers;
  const auto scene = load_scene(open_source(argv[1]), std::pmr::get_default_resource(), workers);
  const auto tree = whole_tree(*scene);
  std::vector<tools::Camera> cameras = tools::read_cameras(argv[2]);
  for (tools::Camera& camera : cameras) camera = camera.resized(width, height);

  struct Layout {
    const char* name;
    Pages pages;
    std::vector<uint32_t> sizes = {};  // nodes of each page
  };
  Layout layouts[] = {{"the file's chunks", chunks_of(*scene, tree->size())},
                      {"breadth first, 107", packed(*tree, parents_of(*tree), 107)},
                      {"depth first, 107", packed(*tree, depth_first(*tree), 107)},
                      {"by octave and place, 107", packed(*tree, by_size(*tree, 1), 107)},
                      {"by octave and place, 450", packed(*tree, by_size(*tree, 1), 450)},
                      {"by half an octave, 107", packed(*tree, by_size(*tree, 0.5), 107)},
                      {"subtrees by octave, place", packed_subtrees(*scene, *tree, 1, false, 107)},
                      {"subtrees by tier, octave", packed_subtrees(*scene, *tree, 1, true, 107)},
                      {"two levels by octave", packed_twos(*tree, 1, 107)}};
  for (Layout& layout : layouts) {
    layout.sizes.resize(*std::max_element(layout.pages.begin(), layout.pages.end()) + size_t{1});
    for (const uint32_t page : layout.pages) ++layout.sizes[page];
  }
  fmt::print("{:>5} {:26} {:>8} {:>9} {:>7}   {:>8} {:>9} {:>7}\n", "tau", "", "reached",
             "of pages", "useful", "seen", "of pages", "useful");
  for (int i = 4; i < argc; ++i) {
    const auto path = tools::cut_path(cameras, std::stod(argv[i]), scene->origin);
    Touched reached_sum[std::size(layouts)], seen_sum[std::size(layouts)];
    for (size_t c = 0; c < cameras.size(); ++c) {
      std::vector<bool> reached(tree->size()), seen(tree->size());
      const Wedge wedge = wedge_of(cameras[c], path[c].centre);
      for (uint32_t n = 0; n < tree->size(); ++n) {
        const NodeRecord& r = tree->records[n];
        if (n == 0) reached[n] = true;
        if (!reached[n]) continue;
        seen[n] = wedge.meets(r.box_min, r.box_max, 0);
        if (tree->is_leaf(n) || tree->screen_size(n, path[c].centre) < path[c].target_size)
          continue;
        for (uint32_t k = 0; k < r.child_count; ++k) reached[tree->first_child[n] + k] = true;
      }
      for (size_t l = 0; l < std::size(layouts); ++l)
        for (const bool is_seen : {false, true}) {
          const Touched found =
              touched(layouts[l].pages, layouts[l].sizes, is_seen ? seen : reached);
          Touched& sum = is_seen ? seen_sum[l] : reached_sum[l];
          sum.nodes += found.nodes, sum.pages += found.pages, sum.held += found.held;
        }
    }
    const double all = static_cast<double>(tree->size()) * static_cast<double>(cameras.size());
    for (size_t l = 0; l < std::size(layouts); ++l) {
      const auto share = [&](const Touched& of) {
        return fmt::format("{:7.1f}% {:8.1f}% {:7.2f}", 100 * of.nodes / all, 100 * of.held / all,
                           of.nodes / of.held);
      };
      fmt::print("{:>5} {:26} {}   {}\n", argv[i], layouts[l].name, share(reached_sum[l]),
                 share(seen_sum[l]));
    }
  }
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "useful_share: {}\n", error.what());
  return 1;
}
