#include "runtime/format/export_flat.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "runtime/base/error.h"
#include "runtime/format/extent_cut.h"
#include "runtime/format/tree_check.h"
#include "runtime/scene/sh_bands.h"

namespace voyager {
namespace {

GaussianCloud room_for_leaves(const SceneFileInfo& info) {
  GaussianCloud cloud;
  const size_t n = info.leaf_count;
  cloud.sh_degree = info.sh_degree;
  cloud.left_out_bands = info.left_out_bands;
  cloud.native = info.native;
  cloud.origin = info.quality == Quality::lossless ? info.source_origin : info.origin;
  cloud.report = info.import;
  cloud.position.resize(3 * n);
  cloud.log_scale.resize(3 * n);
  cloud.rotation.resize(4 * n);
  cloud.opacity.resize(n);
  cloud.sh.resize(n * static_cast<size_t>(cloud.coefficients()) * 3);
  return cloud;
}

void put_leaf(const Chunk& chunk, size_t node, GaussianCloud& cloud) {
  const size_t i = chunk.source_index[node], floats = static_cast<size_t>(cloud.coefficients()) * 3;
  const GaussianWords& w = chunk.words[node];
  const float* position =
      chunk.position_words.empty() ? &w.mean.x : &chunk.position_words[3 * node];
  std::copy_n(position, 3, &cloud.position[3 * i]);
  std::copy_n(&w.log_scale.x, 3, &cloud.log_scale[3 * i]);
  std::copy_n(&w.rotation.w, 4, &cloud.rotation[4 * i]);
  cloud.opacity[i] = chunk.has_logit(node) ? w.opacity : flat_logit(w.opacity);
  std::copy_n(&chunk.sh[node * floats], floats, &cloud.sh[i * floats]);
}

// The one that half of the leaves are not above. leaves: how many have each level.
NativeScale median_scale(const std::array<uint64_t, kFootprintLevels>& leaves,
                         const NativeScale& native) {
  const uint64_t all = std::accumulate(leaves.begin(), leaves.end(), uint64_t{0});
  uint64_t above = 0;
  int level = 0;
  while (level + 1 < native.levels && 2 * (above += leaves[static_cast<size_t>(level)]) < all)
    ++level;
  return {native.source, native.pixel_of(level), native.low_pass};
}

FlatContents announced(const SceneFile& scene, uint64_t count) {
  FlatContents contents;
  contents.count = count;
  contents.sh_degree = scene.info().sh_degree + scene.info().left_out_bands;
  return contents;
}

}  // namespace

FlatContents export_cloud(GaussianCloud cloud, const std::string& path, const FlatOptions& options,
                          const Progress& progress) {
  put_back_zero_bands(cloud);
  cloud.report = {};
  FlatContents contents;
  contents.sh_degree = cloud.sh_degree;
  contents.native = cloud.native;
  contents.add(cloud);
  write_flat_file(path, options, contents, [&](GaussianWriter& writer) { writer.append(cloud); });
  report(progress, "exporting", cloud.size(), cloud.size());
  return contents;
}

GaussianCloud read_leaves(const SceneFile& scene, const Progress& progress) {
  GaussianCloud cloud = room_for_leaves(scene.info());
  std::vector<bool> there(cloud.size());
  size_t leaves = 0;
  std::array<uint64_t, kFootprintLevels> leaves_of_level{};
  TreeCheck check(scene);
  for (uint32_t index = 0; index < scene.chunks().size(); ++index) {
    report(progress, "exporting", index, scene.chunks().size());
    const Chunk chunk = scene.read_chunk(index);
    check.add(chunk, index);
    for (size_t node = 0; node < chunk.node.size(); ++node) {
      if (!chunk.is_leaf(node)) continue;
      const uint32_t i = chunk.source_index[node];
      if (there[i])
        throw Error(ErrorCode::refused_input, scene.name() + ": chunk " + std::to_string(index) +
                                                  ": found source index " + std::to_string(i) +
                                                  " a second time, expected each once");
      there[i] = true;
      ++leaves;
      ++leaves_of_level[static_cast<size_t>(footprint_level_of(chunk.node_code[node]))];
      put_leaf(chunk, node, cloud);
    }
  }
  if (leaves != cloud.size())
    throw Error(ErrorCode::refused_input, scene.name() + ": found " + std::to_string(leaves) +
                                              " leaves, expected " + std::to_string(cloud.size()));
  cloud.native = median_scale(leaves_of_level, cloud.native);
  return cloud;
}

FlatContents export_leaves(const SceneFile& scene, const std::string& path,
                           const FlatOptions& options, const Progress& progress) {
  require_flat_file(path, announced(scene, scene.info().leaf_count), options);
  return export_cloud(read_leaves(scene, progress), path, options, progress);
}

FlatContents export_extent_cut(const SceneFile& scene, uint64_t most, const std::string& path,
                               const FlatOptions& options, const Progress& progress) {
  require_flat_file(path, announced(scene, std::min<uint64_t>(1, scene.info().leaf_count)));
  return export_cloud(read_extent_cut(scene, most, progress), path, options, progress);
}

}  // namespace voyager
