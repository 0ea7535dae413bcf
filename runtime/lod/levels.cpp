#include "runtime/lod/levels.h"

#include "runtime/lod/align.h"
#include "runtime/lod/shape.h"
#include "runtime/lod/summarise.h"

namespace voyager {
namespace {

constexpr size_t kGrain = 256;  // nodes

void allocate_merged(BakedScene& baked) {
  GaussianCloud& merged = baked.merged;
  const size_t count = baked.tree.size() - baked.leaves.size();
  merged.sh_degree = baked.leaves.sh_degree;
  merged.antialiased = baked.leaves.antialiased;
  merged.origin = baked.origin;
  merged.position.resize(3 * count);
  merged.log_scale.resize(3 * count);
  merged.rotation.resize(4 * count);
  merged.opacity.resize(count);
  merged.sh.resize(count * size_t{3} * static_cast<size_t>(merged.coefficients()));
}

// Nodes of one level depend on other levels only.
template <class Body>
void for_level(const std::vector<uint32_t>& levels, size_t level, Workers& workers,
               const Body& body) {
  workers.for_blocks(levels[level + 1] - levels[level], kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) body(levels[level] + static_cast<uint32_t>(i));
  });
}

}  // namespace

std::vector<uint32_t> lay_out_scene(const std::vector<uint32_t>& order, BakedScene& baked) {
  std::vector<uint32_t> levels = lay_out(order, baked);
  baked.axis_code.resize(baked.tree.size());
  allocate_merged(baked);
  return levels;
}

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
