#include "runtime/lod/kept_tree.h"

#include <algorithm>
#include <cmath>

#include "runtime/lod/build.h"
#include "runtime/lod/nesting.h"
#include "runtime/scene/import/hier/tree.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/sanitise.h"
#include "runtime/scene/scale_histogram.h"
#include "runtime/scene/sh_bands.h"

namespace voyager::kept {
namespace {

constexpr size_t kBlock = 16384;  // rows read at a time

std::string text(float value) {
  return std::to_string(value);
}

class Keeper {
 public:
  Keeper(std::shared_ptr<const ByteSource> source, const Progress& progress)
      : file_(std::move(source)), progress_(progress) {}

  KeptTree run() {
    links_ = hier::read_tree(file_);
    baked().kept = true;
    baked().kind = TreeKind::hierarchicalgs;
    baked().tree.blend_share = blend_share(baked().kind);
    link();
    read_boxes();
    nest();
    read_gaussians();
    finish_clouds();
    kept_.unused = links_.unused;
    kept_.childless = links_.childless;
    return std::move(kept_);
  }

 private:
  BakedScene& baked() { return kept_.scene; }

  void link() {
    LodTree& tree = baked().tree;
    const size_t nodes = links_.child_count.size();
    tree.records.resize(nodes);
    tree.first_child.resize(nodes);
    tree.parent.resize(nodes, kNoNode);
    baked().gaussian.resize(nodes);
    baked().node_code.resize(nodes);
    uint32_t next = 1, merged = 0;
    const std::vector<uint32_t> leaves = hier::leaf_gaussians(links_);
    for (uint32_t n = 0; n < nodes; ++n) {
      const uint32_t children = links_.child_count[n];
      tree.records[n].child_count = children;
      if (children == 0) {
        const auto at = std::lower_bound(leaves.begin(), leaves.end(), links_.gaussian[n]);
        baked().gaussian[n] = static_cast<uint32_t>(at - leaves.begin());
        continue;
      }
      baked().gaussian[n] = merged++;
      tree.first_child[n] = next;
      for (uint32_t i = 0; i < children; ++i) tree.parent[next++] = n;
    }
    make_room(leaves.size(), baked().leaves);
    make_room(merged, baked().merged);
  }

  static void make_room(size_t count, GaussianCloud& cloud) {
    cloud.sh_degree = kMaxShDegree;
    cloud.position.resize(3 * count);
    cloud.log_scale.resize(3 * count);
    cloud.rotation.resize(4 * count);
    cloud.opacity.resize(count);
    cloud.sh.resize(kHierShFloats * count);
  }

  void read_boxes() {
    std::vector<uint32_t> node_of(file_.nodes());
    for (uint32_t n = 0; n < links_.file_node.size(); ++n) node_of[links_.file_node[n]] = n;
    for (size_t begin = 0; begin < node_of.size(); begin += kBlock) {
      const std::vector<HierBox> boxes =
          file_.read_boxes(begin, std::min(kBlock, node_of.size() - begin));
      for (size_t i = 0; i < boxes.size(); ++i) {
        check_box(begin + i, boxes[i]);
        NodeRecord& r = baked().tree.records[node_of[begin + i]];
        r.box_min = boxes[i].min;
        r.box_max = boxes[i].max;
        r.extent = boxes[i].size;
      }
    }
  }

  // Comparisons are written so that a NaN fails.
  void check_box(size_t file_node, const HierBox& box) const {
    const std::string node = "node " + std::to_string(file_node);
    for (int axis = 0; axis < 3; ++axis)
      if (!(box.min[axis] > -kMaxCoordinate && box.min[axis] <= box.max[axis] &&
            box.max[axis] < kMaxCoordinate))
        refuse(
            file_.name(), file_.offset_of_box(file_node), node + ", box",
            text(box.min[axis]) + " to " + text(box.max[axis]) + " on axis " + std::to_string(axis),
            "finite and ordered coordinates, below 1e18 in magnitude");
    if (!(box.size >= 0))
      refuse(file_.name(), file_.offset_of_box(file_node), node + ", extent", text(box.size),
             "at least 0");
  }

  // Every search relies on it.
  void nest() {
    LodTree& tree = baked().tree;
    for (size_t n = tree.size(); n-- > 0;) {
      NodeRecord& r = tree.records[n];
      bool grown = false;
      for (uint32_t i = 0; i < r.child_count; ++i) {
        const NodeRecord& child = tree.records[tree.first_child[n] + i];
        if (is_inside(child, r)) continue;
        grown = true;
        for (int axis = 0; axis < 3; ++axis) {
          r.box_min[axis] = std::min(r.box_min[axis], child.box_min[axis]);
          r.box_max[axis] = std::max(r.box_max[axis], child.box_max[axis]);
        }
        r.extent = std::max(r.extent, child.extent);
      }
      kept_.grown += grown;
    }
  }

  void read_gaussians() {
    std::vector<uint32_t> node_of(file_.gaussians(), kNoNode);
    for (uint32_t n = 0; n < links_.gaussian.size(); ++n) node_of[links_.gaussian[n]] = n;
    const std::vector<uint32_t> place_of = make_further();
    for (size_t begin = 0; begin < node_of.size(); begin += kBlock) {
      report(progress_, "reading", begin, node_of.size());
      const size_t count = std::min(kBlock, node_of.size() - begin);
      const std::vector<std::byte> bytes = file_.read_gaussians(begin, count);
      const hier::Rows rows(bytes, count, file_.half());
      for (size_t i = 0; i < count; ++i)
        if (node_of[begin + i] != kNoNode) take(rows, i, begin + i, node_of[begin + i]);
      if (place_of.empty()) continue;
      for (size_t i = 0; i < count; ++i)
        if (const uint32_t place = place_of[begin + i]; place != kNoNode)
          rows.copy_all(i, &baked().further.words[kHierFloats * place]);
    }
    report(progress_, "reading", node_of.size(), node_of.size());
  }

  // Room for the further Gaussians, and the place there of each of the file's, or kNoNode; nothing
  // where there are none.
  std::vector<uint32_t> make_further() {
    if (links_.further.empty()) return {};
    std::vector<uint32_t> place_of(file_.gaussians(), kNoNode);
    uint32_t place = 0;
    for (const FurtherCount& of : links_.further)
      for (uint32_t i = 1; i <= of.count; ++i) place_of[links_.gaussian[of.node] + i] = place++;
    baked().further = {links_.further, std::vector<float>(kHierFloats * place)};
    return place_of;
  }

  void take(const hier::Rows& rows, size_t row, size_t gaussian, uint32_t node) {
    const GaussianWords words = rows.words(row);
    check_words(gaussian, words);
    const bool leaf = baked().tree.is_leaf(node);
    GaussianCloud& cloud = leaf ? baked().leaves : baked().merged;
    const size_t i = baked().gaussian[node];
    std::copy_n(&words.mean.x, 3, &cloud.position[3 * i]);
    std::copy_n(&words.log_scale.x, 3, &cloud.log_scale[3 * i]);
    std::copy_n(&words.rotation.w, 4, &cloud.rotation[4 * i]);
    cloud.opacity[i] = words.opacity;
    rows.copy_sh(row, &cloud.sh[kHierShFloats * i]);
  }

  // sanitise() would drop these.
  void check_words(size_t gaussian, const GaussianWords& words) const {
    const auto check = [&](bool sound, const char* what, float found, const char* expected) {
      if (!sound)
        refuse(file_.name(), file_.offset_of_gaussian(gaussian),
               "Gaussian " + std::to_string(gaussian) + ", " + what, text(found), expected);
    };
    for (int axis = 0; axis < 3; ++axis) {
      const float position = words.mean[axis], scale = words.log_scale[axis];
      check(std::fabs(position) < kMaxCoordinate, "position", position, "a magnitude below 1e18 m");
      check(std::isfinite(scale), "log scale", scale, "a finite one");
    }
    check(std::isfinite(words.opacity), "opacity", words.opacity, "a finite one");
  }

  void finish_clouds() {
    GaussianCloud &leaves = baked().leaves, &merged = baked().merged;
    sanitise(leaves);
    sanitise(merged);
    leaves.report.repaired_scale += merged.report.repaired_scale;
    leaves.report.repaired_rotation += merged.report.repaired_rotation;
    leaves.report.repaired_sh += merged.report.repaired_sh;
    const int degree = std::max(stored_sh_degree(leaves.sh, kMaxShDegree),
                                stored_sh_degree(merged.sh, kMaxShDegree));
    for (GaussianCloud* cloud : {&leaves, &merged}) {
      change_sh_degree(cloud->sh, kMaxShDegree, degree);
      cloud->sh_degree = degree;
      cloud->left_out_bands = kMaxShDegree - degree;
    }
  }

  hier::File file_;
  const Progress& progress_;
  hier::Tree links_;
  KeptTree kept_;
};

}  // namespace
}  // namespace voyager::kept

namespace voyager {

KeptTree read_kept_tree(std::shared_ptr<const ByteSource> source, const Progress& progress) {
  return kept::Keeper(std::move(source), progress).run();
}

std::vector<std::string> notes_of(const KeptTree& kept) {
  std::vector<std::string> notes;
  if (kept.unused != 0)
    notes.push_back(std::to_string(kept.unused) + " Gaussians left out: no node has them");
  if (kept.childless != 0)
    notes.push_back(std::to_string(kept.childless) +
                    " inner nodes without children, which are drawn as leaves are");
  if (kept.grown != 0)
    notes.push_back(std::to_string(kept.grown) +
                    " nodes with a box or an extent that did not hold its children's: grown");
  return notes;
}

}  // namespace voyager
