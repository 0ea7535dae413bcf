#include "runtime/format/export_hier.h"

#include <algorithm>
#include <limits>

#include "runtime/base/error.h"
#include "runtime/math/axes.h"

namespace voyager {
namespace {

constexpr size_t kShFloats = 48;  // [16][3]: always degree 3

struct HierNode {
  int32_t depth, parent, start, count_leafs, count_merged, start_children, count_children;
};
static_assert(sizeof(HierNode) == 28);

struct HierBox {
  Vec3f min;
  float size;
  Vec3f max;
  float size_again;
};
static_assert(sizeof(HierBox) == 32);

// Where each array starts, for a tree of `nodes`.
struct Layout {
  explicit Layout(uint64_t count)
      : positions(4),
        rotations(positions + 12 * count),
        log_scales(rotations + 16 * count),
        opacities(log_scales + 12 * count),
        sh(opacities + 4 * count),
        node_count(sh + 4 * kShFloats * count),
        nodes(node_count + 4),
        boxes(nodes + sizeof(HierNode) * count) {}
  uint64_t positions, rotations, log_scales, opacities, sh, node_count, nodes, boxes;
};

template <class T>
void write_values(AtomicFile& file, uint64_t start, uint64_t first, const std::vector<T>& values,
                  size_t values_each) {
  file.write_at(start + first * values_each * sizeof(T), std::as_bytes(std::span(values)));
}

// Other tools interpolate component by component and know no axis codes.
GaussianWords turned(const GaussianWords& words, int axis_code, bool leaf) {
  GaussianWords out = words;
  out.log_scale = turn_scale(words.log_scale, axis_code);
  out.rotation = normalise(words.rotation);
  if (axis_code != 0) out.rotation = normalise(out.rotation * cube_rotation<float>(axis_code));
  out.opacity = leaf ? sigmoid(words.opacity) : words.opacity;
  return out;
}

void write_gaussians(AtomicFile& file, const Layout& layout, const Chunk& chunk) {
  const size_t n = chunk.records.size(), floats = chunk.sh.size() / n;
  std::vector<Vec3f> positions(n), log_scales(n);
  std::vector<Quatf> rotations(n);
  std::vector<float> opacities(n), sh(n * kShFloats, 0.0f);
  for (size_t i = 0; i < n; ++i) {
    const GaussianWords g =
        turned(chunk.words[i], chunk.axis_code[i], chunk.records[i].child_count == 0);
    positions[i] = g.mean;
    log_scales[i] = g.log_scale;
    rotations[i] = g.rotation;
    opacities[i] = g.opacity;
    std::copy_n(&chunk.sh[i * floats], floats, &sh[i * kShFloats]);
  }
  write_values(file, layout.positions, chunk.first_node, positions, 1);
  write_values(file, layout.rotations, chunk.first_node, rotations, 1);
  write_values(file, layout.log_scales, chunk.first_node, log_scales, 1);
  write_values(file, layout.opacities, chunk.first_node, opacities, 1);
  write_values(file, layout.sh, chunk.first_node, sh, kShFloats);
}

void write_boxes(AtomicFile& file, const Layout& layout, const Chunk& chunk) {
  std::vector<HierBox> boxes;
  boxes.reserve(chunk.records.size());
  for (const NodeRecord& r : chunk.records)
    boxes.push_back({r.box_min, r.extent, r.box_max, r.extent});
  write_values(file, layout.boxes, chunk.first_node, boxes, 1);
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

void write_nodes(AtomicFile& file, const Layout& layout, const Links& links) {
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
    write_values(file, layout.nodes, begin, nodes, 1);
  }
}

}  // namespace

void export_hier(const SceneFile& scene, const std::string& path, const Progress& progress) {
  const uint32_t count = scene.info().node_count;
  if (count > static_cast<uint32_t>(std::numeric_limits<int32_t>::max()))
    throw Error(ErrorCode::unsupported, path + ": found " + std::to_string(count) +
                                            " nodes, expected at most 2147483647 in a .hier file");
  const Layout layout(count);
  AtomicFile file(path);
  file.write_at(0, std::as_bytes(std::span(&count, 1)));
  file.write_at(layout.node_count, std::as_bytes(std::span(&count, 1)));
  Links links;
  links.first_child.reserve(count);
  links.child_count.reserve(count);
  for (uint32_t index = 0; index < scene.chunks().size(); ++index) {
    report(progress, "exporting", index, scene.chunks().size());
    const Chunk chunk = scene.read_chunk(index);
    write_gaussians(file, layout, chunk);
    write_boxes(file, layout, chunk);
    uint32_t child = chunk.first_child;
    for (const NodeRecord& r : chunk.records) {
      links.first_child.push_back(child);
      links.child_count.push_back(r.child_count);
      child += r.child_count;
    }
  }
  set_depths(links);
  write_nodes(file, layout, links);
  file.commit();
  report(progress, "exporting", scene.chunks().size(), scene.chunks().size());
}

}  // namespace voyager
