#include "runtime/frame/sh_runs.h"

#include "runtime/frame/scene_gaussians.h"

namespace voyager {
namespace {

template <class Visit>
void each_run(const SceneFile& file, uint32_t chunk, const Scene& scene, const Visit& visit) {
  for (const NodeRange& range : file.nodes_of(chunk))
    if (range.count != 0 && range.first < gaussian_count(scene)) visit(range.first);
}

}  // namespace

void find_sh_runs(const SceneFile& file, Scene& scene) {
  scene.sh_blocks.assign((gaussian_count(scene) + 31) / 32, {});
  for (uint32_t chunk = 0; chunk < file.chunks().size(); ++chunk)
    each_run(file, chunk, scene,
             [&](uint32_t first) { scene.sh_blocks[first / 32].starts |= 1u << first % 32; });
  scene.sh_scales.assign(number_runs(scene.sh_blocks), {});
}

void set_sh_scales(const SceneFile& file, uint32_t chunk, const ShScales& scales, Scene& scene) {
  const ShGroups groups = packed_sh(scene).groups;
  each_run(file, chunk, scene, [&](uint32_t first) { scene.sh_scales[groups(first)] = scales; });
}

}  // namespace voyager
