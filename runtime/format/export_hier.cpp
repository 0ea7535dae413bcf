#include "runtime/format/export_hier.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "runtime/base/error.h"
#include "runtime/base/output_path.h"
#include "runtime/format/further.h"
#include "runtime/format/tree_check.h"
#include "runtime/math/node_code.h"
#include "runtime/scene/hier_format.h"

namespace voyager {
namespace {

template <class T>
void write_values(AtomicFile& file, uint64_t start, uint64_t first, std::span<const T> values,
                  size_t values_each) {
  file.write_at(start + first * values_each * sizeof(T), std::as_bytes(values));
}

// Where Gaussians stand in the file: those of each node after those of the nodes before it.
class Places {
 public:
  explicit Places(const std::vector<FurtherCount>& further) : further_(further) {
    before_.reserve(further.size() + 1);
    before_.push_back(0);
    for (const FurtherCount& of : further) before_.push_back(before_.back() + of.count);
  }

  // The first of a node's.
  uint32_t of(uint32_t node) const { return node + before_[index(node)]; }
  uint32_t further_of(uint32_t node) const {
    const size_t i = index(node);
    return i < further_.size() && further_[i].node == node ? further_[i].count : 0;
  }
  // Nodes from `node` on, at most `most`, whose first Gaussians are one after the other.
  uint32_t run(uint32_t node, uint32_t most) const {
    const size_t i = index(node);
    return i < further_.size() ? std::min(most, further_[i].node - node + 1) : most;
  }

 private:
  // Of the first entry that is not before the node.
  size_t index(uint32_t node) const {
    const auto at = std::lower_bound(further_.begin(), further_.end(), node,
                                     [](const FurtherCount& f, uint32_t n) { return f.node < n; });
    return static_cast<size_t>(at - further_.begin());
  }

  const std::vector<FurtherCount>& further_;
  std::vector<uint32_t> before_;  // each entry: Gaussians of the entries before it
};

// What a chunk owns, by node id.
struct Nodes {
  explicit Nodes(size_t count)
      : positions(count),
        log_scales(count),
        rotations(count),
        opacities(count),
        sh(count * kHierShFloats, 0.0f),
        boxes(count) {}
  std::vector<Vec3f> positions, log_scales;
  std::vector<Quatf> rotations;
  std::vector<float> opacities, sh;
  std::vector<HierBox> boxes;
};

// Other tools interpolate component by component and know no axis codes. A .hier's own tree goes
// out as it came.
GaussianWords turned(const Chunk& chunk, size_t i) {
  const GaussianWords& words = chunk.words[i];
  GaussianWords out = words;
  if (chunk.linear_leaves) return out;
  const int axis_code = axis_code_of(chunk.node_code[i]);
  out.log_scale = turn_scale(words.log_scale, axis_code);
  out.rotation = normalise(words.rotation);
  if (axis_code != 0) out.rotation = normalise(out.rotation * cube_rotation<float>(axis_code));
  out.opacity = chunk.has_logit(i) ? sigmoid(words.opacity) : words.opacity;
  return out;
}

// Places of the owned nodes in the chunk, by node id.
std::vector<size_t> by_id(const Chunk& chunk) {
  std::vector<size_t> order(chunk.node.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(),
            [&](size_t a, size_t b) { return chunk.node[a] < chunk.node[b]; });
  return order;
}

Nodes gather(const Chunk& chunk) {
  const size_t n = chunk.node.size(), floats = chunk.sh.size() / n;
  const std::vector<size_t> order = by_id(chunk);
  Nodes nodes(n);
  for (size_t to = 0; to < n; ++to) {
    const size_t i = order[to];
    const GaussianWords g = turned(chunk, i);
    const NodeRecord& r = chunk.record_of(i);
    nodes.positions[to] = g.mean;
    nodes.log_scales[to] = g.log_scale;
    nodes.rotations[to] = g.rotation;
    nodes.opacities[to] = g.opacity;
    std::copy_n(&chunk.sh[i * floats], floats, &nodes.sh[to * kHierShFloats]);
    nodes.boxes[to] = {r.box_min, r.extent, r.box_max, r.extent};
  }
  return nodes;
}

// Those of `nodes` that begin with the one at `from`, to `place` and after it.
void write_gaussians(AtomicFile& file, const HierLayout& layout, uint64_t place, size_t count,
                     const Nodes& nodes, size_t from) {
  const auto write = [&](uint64_t start, const auto& values, size_t values_each) {
    write_values(file, start, place,
                 std::span(values).subspan(from * values_each, count * values_each), values_each);
  };
  write(layout.positions, nodes.positions, 1);
  write(layout.rotations, nodes.rotations, 1);
  write(layout.log_scales, nodes.log_scales, 1);
  write(layout.opacities, nodes.opacities, 1);
  write(layout.sh, nodes.sh, kHierShFloats);
}

// `ranges` are the ids of `nodes`.
void write_chunk(AtomicFile& file, const HierLayout& layout, const Places& places,
                 const std::vector<NodeRange>& ranges, const Nodes& nodes) {
  size_t from = 0;
  for (const NodeRange& range : ranges) {
    write_values(file, layout.boxes, range.first, std::span(nodes.boxes).subspan(from, range.count),
                 1);
    for (uint32_t done = 0; done < range.count;) {
      const uint32_t node = range.first + done, count = places.run(node, range.count - done);
      write_gaussians(file, layout, places.of(node), count, nodes, from + done);
      done += count;
    }
    from += range.count;
  }
}

Nodes gather(std::span<const float> words) {
  Nodes nodes(words.size() / kHierFloats);
  for (size_t i = 0; i < nodes.opacities.size(); ++i) {
    const float* g = &words[kHierFloats * i];
    nodes.positions[i] = {g[0], g[1], g[2]};
    nodes.rotations[i] = {g[3], g[4], g[5], g[6]};
    nodes.log_scales[i] = {g[7], g[8], g[9]};
    nodes.opacities[i] = g[10];
    std::copy_n(g + 11, kHierShFloats, &nodes.sh[kHierShFloats * i]);
  }
  return nodes;
}

void write_further_gaussians(AtomicFile& file, const HierLayout& layout, const Places& places,
                             FurtherReader& further) {
  for (const FurtherCount& of : further.nodes())
    for (uint32_t done = 0; done < of.count;) {
      const Nodes block = gather(further.next(of.count - done));
      const auto count = static_cast<uint32_t>(block.opacities.size());
      write_gaussians(file, layout, places.of(of.node) + 1 + done, count, block, 0);
      done += count;
    }
  further.finish();
}

struct Links {
  std::vector<uint32_t> first_child, child_count;
  std::vector<int32_t> depth;  // 0 for a leaf, which has no further Gaussians
};

// Children come after their parent, so that one pass backwards sees them first.
void set_depths(const std::vector<FurtherCount>& further, Links& links) {
  links.depth.resize(links.child_count.size());
  for (const FurtherCount& of : further) links.depth[of.node] = 1;
  for (size_t n = links.depth.size(); n-- > 0;)
    for (uint32_t i = 0; i < links.child_count[n]; ++i)
      links.depth[n] = std::max(links.depth[n], links.depth[links.first_child[n] + i] + 1);
}

void write_nodes(AtomicFile& file, const HierLayout& layout, const Places& places,
                 const Links& links) {
  constexpr size_t kBlock = 65536;
  size_t parent = 0;
  uint32_t siblings_left = 0;
  for (size_t begin = 0; begin < links.depth.size(); begin += kBlock) {
    std::vector<HierNode> nodes;
    for (size_t n = begin; n < std::min(links.depth.size(), begin + kBlock); ++n) {
      // Node ids are breadth-first: the parents of nodes 1, 2, ... appear in order.
      if (n == 1) siblings_left = links.child_count[0];
      while (n > 1 && siblings_left == 0) siblings_left = links.child_count[++parent];
      if (n > 0) --siblings_left;
      const uint32_t children = links.child_count[n], node = static_cast<uint32_t>(n);
      const bool leaf = links.depth[n] == 0;
      nodes.push_back({links.depth[n], n == 0 ? -1 : static_cast<int32_t>(parent),
                       static_cast<int32_t>(places.of(node)), leaf ? 1 : 0,
                       leaf ? 0 : static_cast<int32_t>(1 + places.further_of(node)),
                       children == 0 ? 0 : static_cast<int32_t>(links.first_child[n]),
                       static_cast<int32_t>(children)});
    }
    write_values(file, layout.nodes, begin, std::span<const HierNode>(nodes), 1);
  }
}

void require_countable(uint64_t gaussians, const std::string& path) {
  if (gaussians > static_cast<uint64_t>(std::numeric_limits<int32_t>::max()))
    throw Error(ErrorCode::unsupported,
                path + ": found " + std::to_string(gaussians) +
                    " Gaussians, expected at most 2147483647 in a .hier file");
}

}  // namespace

void export_hier(const SceneFile& scene, const std::string& path, const Progress& progress) {
  const uint32_t count = scene.info().node_count;
  FurtherReader further(scene);
  require_countable(count + further.gaussians(), path);
  const auto gaussians = static_cast<uint32_t>(count + further.gaussians());
  const Places places(further.nodes());
  const HierLayout layout(gaussians, count);
  AtomicFile file(path);
  require_room(path, layout.end);
  file.write_at(0, std::as_bytes(std::span(&gaussians, 1)));
  file.write_at(layout.node_count, std::as_bytes(std::span(&count, 1)));
  Links links;
  links.first_child.resize(count);
  links.child_count.resize(count);
  TreeCheck check(scene);
  for (uint32_t index = 0; index < scene.chunks().size(); ++index) {
    report(progress, "exporting", index, scene.chunks().size());
    const Chunk chunk = scene.read_chunk(index);
    check.add(chunk, index);
    write_chunk(file, layout, places, scene.nodes_of(index), gather(chunk));
    for (size_t i = 0; i < chunk.node.size(); ++i) {
      links.first_child[chunk.node[i]] = chunk.first_child[i];
      links.child_count[chunk.node[i]] = chunk.record_of(i).child_count;
    }
  }
  set_depths(further.nodes(), links);
  write_nodes(file, layout, places, links);
  write_further_gaussians(file, layout, places, further);
  file.commit();
  report(progress, "exporting", scene.chunks().size(), scene.chunks().size());
}

}  // namespace voyager
