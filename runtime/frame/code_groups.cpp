#include "runtime/frame/code_groups.h"

#include "runtime/frame/scene_gaussians.h"

namespace voyager {
namespace {

template <class Visit>
void each_run(const SceneFile& file, uint32_t chunk, const Scene& scene, const Visit& visit) {
  for (const NodeRange& range : file.nodes_of(chunk))
    if (range.count != 0 && range.first < gaussian_count(scene)) visit(range.first);
}

}  // namespace

void find_code_groups(const SceneFile& file, Scene& scene) {
  scene.group_blocks.assign((gaussian_count(scene) + 31) / 32, {});
  for (uint32_t chunk = 0; chunk < file.chunks().size(); ++chunk)
    each_run(file, chunk, scene,
             [&](uint32_t first) { scene.group_blocks[first / 32].starts |= 1u << first % 32; });
  const uint32_t groups = number_runs(scene.group_blocks);
  scene.sh_scales.assign(groups, {});
  scene.mean_grids.assign(groups, {});
}

void set_code_scales(const SceneFile& file, uint32_t index, const Chunk& chunk, Scene& scene) {
  const CodeGroups groups = code_groups(scene);
  each_run(file, index, scene, [&](uint32_t first) {
    scene.sh_scales[groups(first)] = chunk.sh_scale;
    scene.mean_grids[groups(first)] = chunk.mean_grid;
  });
}

}  // namespace voyager
