#include <algorithm>

#include "runtime/base/error.h"
#include "runtime/frame/load.h"
#include "runtime/lod/build.h"
#include "runtime/lod/summarise.h"
#include "runtime/scene/import/importer.h"
#include "runtime/scene/scale_histogram.h"

namespace voyager {
namespace {

void set_bounds(Scene& scene) {
  for (size_t i = 0; i < scene.gaussians.size(); ++i) {
    const Box box = leaf_box(scene.gaussians[i]);
    for (int axis = 0; axis < 3; ++axis) {
      const float lo = box.least[axis], hi = box.most[axis];
      scene.bounds_min[axis] = i == 0 ? lo : std::min(scene.bounds_min[axis], lo);
      scene.bounds_max[axis] = i == 0 ? hi : std::max(scene.bounds_max[axis], hi);
    }
  }
}

}  // namespace

void load_flat(const std::shared_ptr<const ByteSource>& source, Workers& workers, Scene& scene) {
  ImportOptions options;
  options.memory = scene.gaussians.get_allocator().resource();
  GaussianCloud cloud = import_gaussians(source, options);
  if (cloud.size() >= kNoNode)
    throw Error(ErrorCode::unsupported, source->name() + ": found " + std::to_string(cloud.size()) +
                                            " Gaussians, expected fewer than 2^32 - 1");
  scene.storage = Storage::flat;
  scene.sh_degree = cloud.sh_degree;
  scene.profile.input_sh_degree = cloud.input_sh_degree();
  scene.native = known_scale(cloud);
  scene.leaf_count = cloud.size();
  scene.import = cloud.report;
  const std::array<double, 3> origin = scene_origin(cloud);
  scene.origin = {origin[0], origin[1], origin[2]};
  scene.sh = std::move(cloud.sh);
  scene.gaussians.resize(cloud.size());
  workers.for_blocks(cloud.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      GaussianWords words = cloud.words(i);
      words.mean = local_mean(cloud, i, origin);
      scene.gaussians[i] = activate(words, true);
    }
  });
  set_bounds(scene);
  complete_profile(scene, workers);
  // What a node costs beside its Gaussian; a tree has at least one a leaf.
  constexpr uint64_t kNodeBytes = 2 * sizeof(uint32_t) + sizeof(uint8_t);
  scene.notes.push_back(
      {SceneNote::Kind::omitted, 0, scene.gaussians.size() * kNodeBytes, "tree and search",
       "a flat scene draws every Gaussian; bytes are the least that a tree would take"});
  add_notes(scene);
}

}  // namespace voyager
