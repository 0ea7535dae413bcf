#include "runtime/lod/validate.h"

#include <cmath>
#include <cstdio>

#include "runtime/lod/findings.h"

namespace voyager {
namespace {

std::string text(float value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.9g", static_cast<double>(value));
  return buffer;
}

std::string text(const Vec3f& v) {
  return "(" + text(v.x) + ", " + text(v.y) + ", " + text(v.z) + ")";
}

bool inside(const Vec3f& v) {
  return std::fabs(v.x) < kMaxCoordinate && std::fabs(v.y) < kMaxCoordinate &&
         std::fabs(v.z) < kMaxCoordinate;
}

bool at_most(const Vec3f& a, const Vec3f& b) {
  return a.x <= b.x && a.y <= b.y && a.z <= b.z;
}

void check_record(const LodTree& tree, size_t n, Findings& findings) {
  const NodeRecord& r = tree.records[n];
  if (!inside(r.box_min) || !inside(r.box_max))
    findings.add(name_of(n, "box"), text(r.box_min) + " to " + text(r.box_max),
                 "finite coordinates below 1e18 in magnitude");
  else if (!at_most(r.box_min, r.box_max))
    findings.add(name_of(n, "box"), text(r.box_min) + " to " + text(r.box_max),
                 "a least corner at most the other");
  if (!(r.extent >= 0.0f)) findings.add(name_of(n, "extent"), text(r.extent), "at least 0");
}

void check_child(const LodTree& tree, size_t n, size_t child, Findings& findings) {
  const NodeRecord &p = tree.records[n], &c = tree.records[child];
  if (tree.parent[child] != n)
    findings.check_equal(name_of(child, "parent"), uint64_t{tree.parent[child]}, uint64_t{n});
  if (!at_most(p.box_min, c.box_min) || !at_most(c.box_max, p.box_max))
    findings.add(name_of(child, "box"), text(c.box_min) + " to " + text(c.box_max),
                 "inside " + text(p.box_min) + " to " + text(p.box_max) + " of its parent, node " +
                     std::to_string(n));
  if (!(c.extent <= p.extent))
    findings.add(name_of(child, "extent"), text(c.extent),
                 "at most " + text(p.extent) + " of its parent, node " + std::to_string(n));
}

// Children follow those of the node before, so one running count is the whole
// topology: no id that a broken tree claims is ever followed.
void check_nodes(const LodTree& tree, Findings& findings) {
  const size_t nodes = tree.size();
  size_t next = 1;
  for (size_t n = 0; n < nodes && !findings.full(); ++n) {
    if (n > 0 && n >= next) {
      findings.add(name_of(n, "parent"), "no earlier node with this child",
                   "every node but the root to be a child");
      return;
    }
    check_record(tree, n, findings);
    const size_t children = tree.records[n].child_count;
    if (children == 0) continue;
    if (tree.first_child[n] != next)
      findings.check_equal(name_of(n, "first child"), size_t{tree.first_child[n]}, next);
    if (children > nodes - next) {
      findings.add(name_of(n, "child count"), std::to_string(children),
                   "at most " + std::to_string(nodes - next) + ", the nodes that are left");
      return;
    }
    for (const size_t end = next + children; next < end; ++next)
      check_child(tree, n, next, findings);
  }
}

}  // namespace

std::vector<std::string> validate(const LodTree& tree, size_t limit) {
  Findings findings(limit);
  const size_t nodes = tree.size();
  findings.check_equal("tree, first children", tree.first_child.size(), nodes);
  findings.check_equal("tree, parents", tree.parent.size(), nodes);
  if (nodes >= kNoNode)
    findings.add("tree, nodes", std::to_string(nodes), "less than " + std::to_string(kNoNode));
  std::vector<std::string> sizes = findings.take();
  if (!sizes.empty() || nodes == 0) return sizes;
  if (tree.parent[0] != kNoNode) findings.check_equal("node 0, parent", tree.parent[0], kNoNode);
  check_nodes(tree, findings);
  return findings.take();
}

}  // namespace voyager
