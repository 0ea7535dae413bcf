#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "runtime/lod/align.h"
#include "runtime/lod/findings.h"
#include "runtime/lod/summarise.h"
#include "runtime/lod/validate.h"
#include "runtime/math/axes.h"

namespace voyager {
namespace {

std::string text(double value) {
  std::ostringstream out;
  out.precision(9);
  out << value;
  return out.str();
}

void check_arrays(const char* cloud_name, const GaussianCloud& cloud, Findings& findings) {
  const std::string name = cloud_name;
  const size_t count = cloud.size();
  findings.check_equal(name + ", position words", cloud.position.size(), 3 * count);
  findings.check_equal(name + ", log scale words", cloud.log_scale.size(), 3 * count);
  findings.check_equal(name + ", rotation words", cloud.rotation.size(), 4 * count);
  if (cloud.sh_degree < 0 || cloud.sh_degree > kMaxShDegree)
    findings.add(name + ", SH degree", std::to_string(cloud.sh_degree), "0 to 3");
  else
    findings.check_equal(name + ", SH words", cloud.sh.size(),
                         count * size_t{3} * static_cast<size_t>(cloud.coefficients()));
}

// Each Gaussian of both clouds belongs to exactly one node. With as many
// nodes as Gaussians, none twice and none out of range leaves none out.
void check_gaussians(const BakedScene& baked, Findings& findings) {
  const size_t leaves = baked.leaves.size(), merged = baked.merged.size();
  findings.check_equal("tree, nodes", baked.tree.size(), leaves + merged);
  std::vector<bool> leaf_seen(leaves), merged_seen(merged);
  for (uint32_t n = 0; n < baked.tree.size() && !findings.full(); ++n) {
    const bool leaf = baked.tree.is_leaf(n);
    std::vector<bool>& seen = leaf ? leaf_seen : merged_seen;
    const size_t i = baked.gaussian[n];
    const char* what = leaf ? "Gaussian of a leaf" : "merged Gaussian";
    if (i >= seen.size())
      findings.add(name_of(n, what), std::to_string(i), "less than " + std::to_string(seen.size()));
    else if (seen[i])
      findings.add(name_of(n, what), std::to_string(i) + " again", "each of them in one node");
    else
      seen[i] = true;
  }
}

void check_leaf_box(const BakedScene& baked, uint32_t n, Findings& findings) {
  const NodeRecord& r = baked.tree.records[n];
  const Box box = leaf_box(node_gaussian(n, baked).gaussian);
  for (int axis = 0; axis < 3; ++axis) {
    if (r.box_min[axis] <= box.least[axis] && r.box_max[axis] >= box.most[axis]) continue;
    findings.add(
        name_of(n, "box of a leaf"),
        text(r.box_min[axis]) + " to " + text(r.box_max[axis]) + " on axis " + std::to_string(axis),
        text(box.least[axis]) + " to " + text(box.most[axis]) + " covered");
  }
}

// NaN is never near.
void check_near(uint32_t n, const char* what, double found, double expected, double tolerance,
                Findings& findings) {
  if (!(std::fabs(found - expected) <= tolerance))
    findings.add(name_of(n, what), text(found), text(expected) + " ± " + text(tolerance));
}

void check_sh(uint32_t n, const BakedScene& baked, const std::vector<MergeInput>& children,
              double total, Findings& findings) {
  double expected[3 * sh_coefficients(kMaxShDegree)] = {};
  double largest[3 * sh_coefficients(kMaxShDegree)] = {};
  const int words = 3 * baked.merged.coefficients();
  for (const MergeInput& child : children) {
    const double weight =
        total > 0.0 ? child.weight / total : 1.0 / static_cast<double>(children.size());
    for (int k = 0; k < words; ++k) {
      expected[k] += weight * double{child.sh[k]};
      largest[k] = std::max(largest[k], std::fabs(double{child.sh[k]}));
    }
  }
  // Trained scenes hold subnormal coefficients: the words' step is then all there is.
  const double step = std::numeric_limits<float>::denorm_min();
  const float* found = node_gaussian(n, baked).sh;
  for (int k = 0; k < words; ++k)
    check_near(n, "SH", found[k], expected[k], kShTolerance * largest[k] + step, findings);
}

void check_moments(uint32_t n, const BakedScene& baked, std::vector<MergeInput>& children,
                   Findings& findings) {
  children.clear();
  for (uint32_t i = 0; i < baked.tree.records[n].child_count; ++i)
    children.push_back(merge_input(baked.tree.first_child[n] + i, baked.footprint_of(n), baked));
  const MergeInput parent = node_gaussian(n, baked);
  const Moments expected = moments(children), found = moments({&parent, 1});

  const double* c = expected.covariance;
  const double trace = c[0] + c[3] + c[5];
  const Vec3d& m = expected.mean;
  const double reach = std::max({std::fabs(m.x), std::fabs(m.y), std::fabs(m.z), std::sqrt(trace)});
  for (int axis = 0; axis < 3; ++axis)
    check_near(n, "mean", found.mean[axis], m[axis], kMeanTolerance * reach, findings);
  // The means that deviations are taken from are rounded, even in binary64.
  const double step = 4 * std::numeric_limits<double>::epsilon() * reach;
  const double slack =
      kCovarianceTolerance * (trace + kMinMergedScale * kMinMergedScale) + step * step;
  for (int k = 0; k < 6; ++k) {
    const bool diagonal = k == 0 || k == 3 || k == 5;
    const double floor = diagonal ? kMinMergedScale * kMinMergedScale : 0.0;
    check_near(n, "covariance", found.covariance[k], c[k], slack + floor, findings);
  }
  if (baked.kind == TreeKind::hierarchicalgs) {
    const double least = 1e-38;  // where the opacity's word becomes subnormal, digits go
    check_near(n, "opacity times surface", found.weight, expected.weight,
               kWeightTolerance * expected.weight + least * std::max(trace, 1.0), findings);
  } else if (const float opacity = parent.gaussian.opacity;
             !(opacity >= 0 && opacity <= std::numeric_limits<float>::max())) {
    findings.add(name_of(n, "opacity"), text(opacity), "a finite one of at least 0");
  }
  check_sh(n, baked, children, expected.weight, findings);
}

// What learned, or came with its tree, is anything that can be drawn and stored.
void check_drawable(uint32_t n, const BakedScene& baked, Findings& findings) {
  const MergeInput node = node_gaussian(n, baked);
  const Gaussian& g = node.gaussian;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::fabs(g.mean[axis]) < kMaxCoordinate))
      findings.add(name_of(n, "mean"), text(g.mean[axis]), "a magnitude below 1e18 m");
    if (!(g.scale[axis] > 0 && g.scale[axis] < kMaxCoordinate))
      findings.add(name_of(n, "scale"), text(g.scale[axis]), "above 0 and below 1e18 m");
  }
  if (!(g.opacity >= 0 && g.opacity <= std::numeric_limits<float>::max()))
    findings.add(name_of(n, "opacity"), text(g.opacity), "a finite one of at least 0");
  for (int k = 0; k < 3 * baked.merged.coefficients(); ++k)
    if (!std::isfinite(node.sh[k])) findings.add(name_of(n, "SH"), text(node.sh[k]), "finite");
}

void check_footprint(uint32_t n, const BakedScene& baked, Findings& findings) {
  const int level = footprint_level_of(baked.node_code[n]);
  int expected = 0;
  for (uint32_t i = 0; i < baked.tree.records[n].child_count; ++i)
    expected =
        std::max(expected, footprint_level_of(baked.node_code[baked.tree.first_child[n] + i]));
  if (level >= baked.leaves.native.levels)
    findings.add(name_of(n, "footprint level"), std::to_string(level),
                 "less than " + std::to_string(baked.leaves.native.levels));
  else if (!baked.tree.is_leaf(n) && level != expected)
    findings.add(name_of(n, "footprint level"), std::to_string(level), std::to_string(expected));
}

void check_axes(uint32_t n, const BakedScene& baked, Findings& findings) {
  const int code = axis_code_of(baked.node_code[n]);
  const uint32_t parent = baked.tree.parent[n];
  if (code != 0 && (parent == kNoNode || !baked.tree.is_leaf(n))) {
    findings.add(name_of(n, "axis code"), std::to_string(code),
                 "0, or up to 23 for a leaf with a parent");
    return;
  }
  if (parent == kNoNode) return;
  const Quatd p = stored_rotation(parent, baked), q = stored_rotation(n, baked);
  const auto nearness = [&](int candidate) {
    const Quatd t = q * cube_rotation<double>(candidate);
    return std::fabs(((p.w * t.w + p.x * t.x) + p.y * t.y) + p.z * t.z);
  };
  const int best = nearest_axis_code(p, q);
  if (!(nearness(code) >= nearness(best) - kAxisTolerance))
    findings.add(name_of(n, "axis code"), std::to_string(code), std::to_string(best));
}

}  // namespace

std::vector<std::string> validate(const BakedScene& baked, size_t limit) {
  std::vector<std::string> broken = validate(baked.tree, limit);
  if (!broken.empty()) return broken;
  Findings findings(limit);
  check_arrays("leaves", baked.leaves, findings);
  check_arrays("merged", baked.merged, findings);
  findings.check_equal("merged, SH degree", baked.merged.sh_degree, baked.leaves.sh_degree);
  findings.check_equal("tree, Gaussian indices", baked.gaussian.size(), baked.tree.size());
  findings.check_equal("tree, node codes", baked.node_code.size(), baked.tree.size());
  broken = findings.take();
  if (!broken.empty()) return broken;
  check_gaussians(baked, findings);
  broken = findings.take();
  if (!broken.empty()) return broken;

  std::vector<MergeInput> children;
  for (uint32_t n = 0; n < baked.tree.size() && !findings.full(); ++n) {
    check_footprint(n, baked, findings);
    if (baked.kept) {
      check_drawable(n, baked, findings);
      continue;
    }
    if (baked.tree.is_leaf(n))
      check_leaf_box(baked, n, findings);
    else if (baked.learned)
      check_drawable(n, baked, findings);
    else
      check_moments(n, baked, children, findings);
    check_axes(n, baked, findings);
  }
  return findings.take();
}

}  // namespace voyager
