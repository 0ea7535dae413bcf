#pragma once
// The ways to find a cut. All give the same set of node ids; what differs is what
// they read.
#include <cstdint>

namespace voyager {

enum class Search {
  exhaustive,      // every node: the baseline and the oracle
  streaming,       // chunk by chunk from the top, skipping those that no refined node leads to
  temporal,        // the last cut's subtrees, where their slack has run out
  temporal_visit,  // the same, but visiting every subtree of the last cut, as the paper does
  sweep,           // every node that has children, in one pass over compact records; on CUDA, of a
                   // resident scene without damage whose leaves have no extent. Else temporal runs
  fastest,         // to ask for, never in stats: sweep where it is faster than temporal
};

// What runs where no sweep does.
constexpr Search without_sweep(Search kind) {
  return kind == Search::sweep || kind == Search::fastest ? Search::temporal : kind;
}

// Of one run.
struct SearchStats {
  Search ran =
      Search::exhaustive;     // a temporal search starts with, and may fall back to, streaming
  uint64_t nodes_tested = 0;  // evaluations of the predicate, those of hulls included
  uint64_t subtrees_visited = 0;
  uint64_t chunks_read = 0;        // that hold a visited subtree; exhaustive: 0
  uint64_t bytes_read = 0;         // of search records, subtree tables, chunk hulls and kept state
  uint64_t entered = 0, left = 0;  // nodes, against the run before
  uint64_t stand_ins = 0;          // cut nodes of size ≥ τ* whose children are not there
};

}  // namespace voyager
