#include "tools/report/report_scenes.h"

#include "runtime/base/open_source.h"
#include "runtime/format/export_flat.h"
#include "runtime/format/writer.h"
#include "runtime/frame/scene_gaussians.h"
#include "runtime/lod/build.h"
#include "runtime/scene/import/importer.h"
#include "tools/report/kept_files.h"

namespace voyager::tools {
namespace {

std::vector<Storage> storages_of(Storage own) {
  if (own == Storage::compact) return {Storage::compact};
  if (own == Storage::lossless) return {Storage::lossless, Storage::compact};
  return {Storage::flat, Storage::lossless, Storage::compact};
}

}  // namespace

ReportScenes::ReportScenes(const std::string& path, const std::filesystem::path& folder,
                           Workers& workers, Progress progress)
    : path_(path), folder_(folder), workers_(workers), progress_(std::move(progress)) {
  report(progress_, "opening", 0, 0);
  own_ = load_scene(open_source(path), std::pmr::get_default_resource(), workers);
  report(progress_, "opening", 1, 1);
  storages_ = storages_of(own_->storage);
}

std::shared_ptr<const Scene> ReportScenes::get(Storage storage, int sh_degree) {
  if (storage == storages_.front() && sh_degree == own_->sh_degree) return own_;
  if (other_ && other_storage_ == storage && other_->sh_degree == sh_degree) return other_;
  other_.reset();
  const std::shared_ptr<Scene> scene =
      load_scene(open_source(path_of(storage)), std::pmr::get_default_resource(), workers_);
  lower_sh_degree(sh_degree, *scene);
  other_storage_ = storage;
  other_ = scene;
  return scene;
}

std::string ReportScenes::path_of(Storage storage) {
  if (storage == storages_.front()) return path_;
  const std::filesystem::path path =
      folder_ / (storage == Storage::lossless ? kLosslessScene : kCompactScene);
  if (!std::filesystem::exists(path)) bake(storage, path);
  return path.string();
}

void ReportScenes::bake(Storage storage, const std::filesystem::path& output) {
  std::filesystem::path input = path_;
  TreeRule rule;
  NativeScale native;
  std::vector<uint8_t> levels;
  if (own_->storage != Storage::flat) {
    const SceneFile file(open_source(path_));
    // Others would be compared, too.
    rule.kind = file.info().tree;
    native = file.info().native;
    input = folder_ / kSceneLeaves;
    export_leaves(file, input.string(), {}, progress_);
    const GaussianArrays arrays = gaussian_arrays(*own_);
    for (const uint32_t leaf : own_->leaves)
      levels.push_back(static_cast<uint8_t>(footprint_level_of(arrays.node_code(leaf))));
  }
  ImportOptions options;
  options.progress = progress_;
  GaussianCloud cloud = import_gaussians(open_source(input.string()), options);
  if (native.source != NativeSource::unknown) cloud.native = native;
  const BakedScene baked =
      build_tree(std::move(cloud), workers_, progress_, rule, {.known = levels});
  write_scene_file(baked, partition_tree(baked.tree, kDefaultChunkBytes), output.string(),
                   storage == Storage::compact ? Quality::compact : Quality::lossless, workers_,
                   progress_);
  if (own_->storage != Storage::flat) std::filesystem::remove(folder_ / kSceneLeaves);
}

}  // namespace voyager::tools
