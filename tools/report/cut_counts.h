#pragma once
// How large a tree's cuts are, and the tau of a cut that is wanted: without drawing, and without
// listing a cut.
#include <functional>
#include <vector>

#include "runtime/lod/tree.h"

namespace voyager {
class Workers;
}

namespace voyager::tools {

// Of one tree, seen from one point at a time. 12 bytes an interior node.
class CutCounts {
 public:
  // The tree is sound (runtime/lod/validate.h) and outlives this.
  CutCounts(const LodTree& tree, Workers& workers);

  void look_from(const Vec3f& centre);
  // Nodes of the cut at this τ*, by testing every interior node, as an exhaustive search does.
  uint64_t at(float target_size) const;

 private:
  const LodTree& tree_;
  Workers& workers_;
  std::vector<uint32_t> interior_;  // node ids
  std::vector<uint32_t> added_;     // nodes that a cut has more for each that is refined
  std::vector<float> sizes_;
};

struct TauOfCut {
  double tau;
  uint64_t cut;
};

// The tau from 0 to 2^20 whose cut is nearest to so many nodes, to 10^-4 of these where a cut is
// so near: by bisection on log tau. cut_at never grows with tau.
TauOfCut tau_of_cut(uint64_t wanted, const std::function<uint64_t(double)>& cut_at);

}  // namespace voyager::tools
