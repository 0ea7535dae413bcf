#pragma once
// A scene as a report draws it: in each storage, and with fewer SH bands than it has.
#include <filesystem>
#include <memory>
#include <vector>

#include "runtime/base/progress.h"
#include "runtime/frame/scene.h"

namespace voyager::tools {

class ReportScenes {
 public:
  // folder: for the bakes that the scene's own file lacks. A flat file, and a lossless .voy, also
  // come compact; a compact one does not come back. Throws as load_scene() does.
  ReportScenes(const std::string& path, const std::filesystem::path& folder, Workers& workers,
               Progress progress);

  // The file's own first.
  const std::vector<Storage>& storages() const { return storages_; }
  const std::shared_ptr<const Scene>& own() const { return own_; }
  // sh_degree: at most own()'s. Keeps the last one that is not own().
  std::shared_ptr<const Scene> get(Storage storage, int sh_degree);

 private:
  std::string path_of(Storage storage);
  void bake(Storage storage, const std::filesystem::path& output);

  std::string path_;
  std::filesystem::path folder_;
  Workers& workers_;
  Progress progress_;
  std::vector<Storage> storages_;
  std::shared_ptr<const Scene> own_, other_;
  Storage other_storage_ = Storage::flat;
};

}  // namespace voyager::tools
