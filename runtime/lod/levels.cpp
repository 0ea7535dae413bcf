#include "runtime/lod/levels.h"

#include "runtime/lod/align.h"
#include "runtime/lod/summarise.h"

namespace voyager {
namespace {

constexpr size_t kGrain = 256;  // nodes

// Nodes of one level depend on other levels only.
template <class Body>
void for_level(const std::vector<uint32_t>& levels, size_t level, Workers& workers,
               const Body& body) {
  workers.for_blocks(levels[level + 1] - levels[level], kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) body(levels[level] + static_cast<uint32_t>(i));
  });
}

}  // namespace

void summarise_levels(const std::vector<uint32_t>& levels, BakedScene& baked, Workers& workers,
                      const Progress& progress) {
  const size_t nodes = baked.tree.size();
  for (size_t level = levels.size() - (nodes > 0); level-- > 0;) {
    for_level(levels, level, workers, [&](uint32_t node) { summarise(node, baked); });
    report(progress, "merging", nodes - levels[level], nodes);
  }
}

void align_levels(const std::vector<uint32_t>& levels, BakedScene& baked, Workers& workers,
                  const Progress& progress) {
  const size_t nodes = baked.tree.size();
  for (size_t level = 0; level + 1 < levels.size(); ++level) {
    for_level(levels, level, workers, [&](uint32_t node) { align_children(node, baked); });
    report(progress, "aligning", levels[level + 1], nodes);
  }
}

}  // namespace voyager
