#pragma once
// The rules that a tree may be built by.
#include <cstdlib>
#include <ostream>
#include <string>
#include <vector>

#include "runtime/lod/tree_rule.h"

namespace voyager::test {

// Of blocks so small that some thousand Gaussians have many, and cells to be baked in.
inline constexpr TreeRule kSmallBlocks{
    .kind = TreeKind::clustered, .block = 16, .exposure_block = 256};
inline constexpr TreeRule kHierarchicalGs{.kind = TreeKind::hierarchicalgs};

// Whole paths through trees of the default's blocks take minutes: scripts/check.sh searches asks
// for them.
inline bool whole_paths() {
  return std::getenv("VOYAGER_WHOLE_PATHS") != nullptr;
}

// For cities, real and made up: clustering some ten thousand Gaussians takes a second in small
// blocks and a minute in the default's. The tree is of the same kind on every machine.
inline TreeRule city_rule() {
  return whole_paths() ? TreeRule() : kSmallBlocks;
}

struct NamedRule {
  std::string name;
  TreeRule rule;

  friend void PrintTo(const NamedRule& named, std::ostream* out) { *out << named.name; }
};

inline std::vector<NamedRule> all_rules() {
  return {{"clustered", {}}, {"small_blocks", kSmallBlocks}, {"hierarchicalgs", kHierarchicalGs}};
}

// For INSTANTIATE_TEST_SUITE_P.
template <class Info>
std::string rule_name(const Info& info) {
  return info.param.name;
}

}  // namespace voyager::test
