#pragma once
// The rules that a tree may be built by.
#include <ostream>
#include <string>
#include <vector>

#include "runtime/lod/tree_rule.h"

namespace voyager::test {

// Of blocks so small that some thousand Gaussians have many, and cells to be baked in.
inline constexpr TreeRule kSmallBlocks{
    .kind = TreeKind::clustered, .block = 16, .exposure_block = 256};
inline constexpr TreeRule kHierarchicalGs{.kind = TreeKind::hierarchicalgs};
// The default's, but under AddressSanitizer and emulation: clustering a real scene takes minutes
// there.
#if defined(__SANITIZE_ADDRESS__) || defined(VOYAGER_EMULATED)
inline constexpr TreeRule kLargeScene = kHierarchicalGs;
#else
inline constexpr TreeRule kLargeScene{};
#endif

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
