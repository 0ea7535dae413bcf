#include "runtime/format/export_hier.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "runtime/base/error.h"
#include "runtime/base/output_path.h"
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

// `ranges` are the ids of `nodes`.
void write_chunk(AtomicFile& file, const HierLayout& layout, const std::vector<NodeRange>& ranges,
                 const Nodes& nodes) {
  size_t from = 0;
  for (const NodeRange& range : ranges) {
    const auto write = [&](uint64_t start, const auto& values, size_t values_each) {
      write_values(file, start, range.first,
                   std::span(values).subspan(from * values_each, range.count * values_each),
                   values_each);
    };
    write(layout.positions, nodes.positions, 1);
    write(layout.rotations, nodes.rotations, 1);
    write(layout.log_scales, nodes.log_scales, 1);
    write(layout.opacities, nodes.opacities, 1);
    write(layout.sh, nodes.sh, kHierShFloats);
    write(layout.boxes, nodes.boxes, 1);
    from += range.count;
  }
}

struct Links {
  std::vector<uint32_t> first_child, child_count;
  std::vector<int32_t> depth;  // 0 for a leaf
};

// Children come after their parent, so that one pass backwards sees them first.
void set_depths(Links& links) {
  links.depth.resize(links.child_count.size());
  for (size_t n = links.depth.size(); n-- > 0;)
    for (uint32_t i = 0; i < links.child_count[n]; ++i)
      links.depth[n] = std::max(links.depth[n], links.depth[links.first_child[n] + i] + 1);
}

void write_nodes(AtomicFile& file, const HierLayout& layout, const Links& links) {
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
      const uint32_t children = links.child_count[n];
      nodes.push_back({links.depth[n], n == 0 ? -1 : static_cast<int32_t>(parent),
                       static_cast<int32_t>(n), children == 0 ? 1 : 0, children == 0 ? 0 : 1,
                       children == 0 ? 0 : static_cast<int32_t>(links.first_child[n]),
                       static_cast<int32_t>(children)});
    }
    write_values(file, layout.nodes, begin, std::span<const HierNode>(nodes), 1);
  }
}

}  // namespace

void export_hier(const SceneFile& scene, const std::string& path, const Progress& progress) {
  const uint32_t count = scene.info().node_count;
  if (count > static_cast<uint32_t>(std::numeric_limits<int32_t>::max()))
    throw Error(ErrorCode::unsupported, path + ": found " + std::to_string(count) +
                                            " nodes, expected at most 2147483647 in a .hier file");
  const HierLayout layout(count, count);
  AtomicFile file(path);
  require_room(path, layout.end);
  file.write_at(0, std::as_bytes(std::span(&count, 1)));
  file.write_at(layout.node_count, std::as_bytes(std::span(&count, 1)));
  Links links;
  links.first_child.resize(count);
  links.child_count.resize(count);
  TreeCheck check(scene);
  for (uint32_t index = 0; index < scene.chunks().size(); ++index) {
    report(progress, "exporting", index, scene.chunks().size());
    const Chunk chunk = scene.read_chunk(index);
    check.add(chunk, index);
    write_chunk(file, layout, scene.nodes_of(index), gather(chunk));
    for (size_t i = 0; i < chunk.node.size(); ++i) {
      links.first_child[chunk.node[i]] = chunk.first_child[i];
      links.child_count[chunk.node[i]] = chunk.record_of(i).child_count;
    }
  }
  set_depths(links);
  write_nodes(file, layout, links);
  file.commit();
  report(progress, "exporting", scene.chunks().size(), scene.chunks().size());
}

}  // namespace voyager
