#pragma once
// METHOD §3: which nodes of the tree stand for the scene. Selection is a pure
// function of tree, missing nodes and query: no I/O, no GPU, no history. Every
// search returns the same set of node ids, to the bit.
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/base/workers.h"
#include "runtime/lod/tree.h"

namespace voyager {

struct CutQuery {
  Vec3f centre;       // scene-local metres, finite, below 1e18
  float target_size;  // τ* = target_size(τ, f_x) of runtime/math/screen_size.h; > 0, +inf allowed

  bool operator==(const CutQuery& other) const {
    return centre.x == other.centre.x && centre.y == other.centre.y && centre.z == other.centre.z &&
           target_size == other.target_size;
  }
};

// Nodes [first, first + count) whose chunk is not resident: their records are
// never read. A list of them is ascending and disjoint.
struct MissingNodes {
  uint32_t first, count;
};

// What sizes() holds for a missing node; below every real size.
inline constexpr float kMissingSize = -1.0f;

// Tests every resident node: the baseline and the oracle of the other searches.
// Not thread-safe (it owns its scratch); the work is spread over `workers`, and
// the result does not depend on their number. Scratch is 12 bytes a node from
// the given resource, which must outlive the search; nothing is allocated by a
// run over a tree no larger than one before. Throws only std::bad_alloc.
class ExhaustiveSearch {
 public:
  explicit ExhaustiveSearch(std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  // The tree is sound (runtime/lod/validate.h) outside `missing`. Each resident
  // node names its true parent, or kNoNode where that could not be read.
  void run(const LodTree& tree, std::span<const MissingNodes> missing, const CutQuery& query,
           Workers& workers);

  // Results of the last run, valid until the next.
  // Node ids, ascending: the whole tree's cut, less the missing nodes and those
  // whose parent is missing.
  const std::pmr::vector<uint32_t>& cut() const { return cut_; }
  // By node id: screen_size(), or kMissingSize.
  std::span<const float> sizes() const { return sizes_; }
  // Evaluations of the predicate.
  uint64_t nodes_tested() const { return nodes_tested_; }
  // The smallest id of a missing node that this cut needs (the root, or a child
  // of a resident node with size ≥ τ*); kNoNode if the cut is whole. What is
  // below that node may be in cut() all the same.
  uint32_t needed_missing() const { return needed_missing_; }

 private:
  struct BlockResult {
    uint32_t selected;
    uint32_t needed_missing;
  };

  void measure(const LodTree& tree, std::span<const MissingNodes> missing, const CutQuery& query,
               size_t begin, size_t end);
  BlockResult select(const LodTree& tree, float target, size_t begin, size_t end);
  void gather();

  std::pmr::vector<float> sizes_;
  std::pmr::vector<uint32_t> selected_;  // each block's ids from the block's own begin
  std::pmr::vector<BlockResult> blocks_;
  std::pmr::vector<uint32_t> cut_;
  uint64_t nodes_tested_ = 0;
  uint32_t needed_missing_ = kNoNode;
};

}  // namespace voyager
