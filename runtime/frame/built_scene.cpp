#include "runtime/frame/built_scene.h"

#include <algorithm>

#include "runtime/lod/summarise.h"

namespace voyager {

std::shared_ptr<Scene> scene_of(const BakedScene& baked, Workers& workers) {
  auto scene = std::make_shared<Scene>(baked.tree.records.get_allocator().resource());
  const size_t nodes = baked.tree.size();
  scene->name = "the scene that is being baked";
  scene->storage = Storage::lossless;
  scene->sh_degree = baked.leaves.sh_degree;
  scene->native = baked.leaves.native;
  scene->origin = {baked.origin[0], baked.origin[1], baked.origin[2]};
  scene->leaf_count = baked.leaves.size();
  scene->node_count = nodes;
  scene->tree = baked.tree;
  scene->node_code = baked.node_code;
  scene->gaussians.resize(nodes);
  scene->leaves.resize(baked.leaves.size(), kNoNode);
  const size_t floats = 3 * static_cast<size_t>(scene->coefficients());
  scene->sh.resize(nodes * floats);
  workers.for_blocks(nodes, 4096, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) {
      const auto node = static_cast<uint32_t>(n);
      const MergeInput of = node_gaussian(node, baked);
      scene->gaussians[n] = of.gaussian;
      std::copy_n(of.sh, floats, scene->sh.data() + n * floats);
      if (baked.tree.is_leaf(node)) scene->leaves[baked.gaussian[n]] = node;
    }
  });
  return scene;
}

}  // namespace voyager
