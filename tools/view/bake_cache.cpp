#include "tools/view/bake_cache.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "runtime/bake/work_folder.h"
#include "runtime/base/checksum.h"
#include "runtime/base/error.h"
#include "runtime/format/layout.h"

namespace voyager::view {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWork = ".work";

fs::path cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && *cache != '\0') return fs::path(cache) / "voyager";
  const char* home = std::getenv("HOME");
  // No folder that others write to, in which one of them may have put a bake of that name.
  if (home == nullptr || *home == '\0')
    throw Error(ErrorCode::io,
                "the viewer's cache: found neither XDG_CACHE_HOME nor HOME in the environment, "
                "expected a folder for the bake: --keep names a file for it");
  return fs::path(home) / ".cache/voyager";
}

// "" for a URL, whose size must do.
std::string time_of_change(const std::string& scene) {
  std::error_code no_file;
  const auto time = fs::last_write_time(scene, no_file);
  return no_file ? "" : std::to_string(time.time_since_epoch().count());
}

std::string full_name(const std::string& scene) {
  std::error_code no_file;
  const fs::path path = fs::canonical(scene, no_file);
  return no_file ? scene : path.string();
}

}  // namespace

std::string cached_bake(const std::string& scene, const ByteSource& source) {
  const std::string about = fmt::format("{}\n{}\n{}\n{}", full_name(scene), source.size(),
                                        time_of_change(scene), kSceneVersion);
  return (cache_folder() / fmt::format("{}-{:016x}.voy",
                                       fs::path(scene.substr(0, scene.find('?'))).stem().string(),
                                       checksum(std::as_bytes(std::span(about)))))
      .string();
}

void make_cache_folder() {
  const fs::path folder = cache_folder();
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (problem)
    throw Error(ErrorCode::io, folder.string() + ": " + problem.message() +
                                   ", expected a folder for the bake: --keep names a file for it");
}

std::string work_folder(const std::string& bake) {
  return bake + kWork;
}

void trim_cache(const std::string& used) {
  struct Kept {
    fs::path path;
    fs::file_time_type time;
    uint64_t bytes;
  };
  std::error_code ignored;
  fs::last_write_time(used, fs::file_time_type::clock::now(), ignored);
  std::vector<Kept> files;
  uint64_t sum = 0;
  for (const auto& entry : fs::directory_iterator(cache_folder(), ignored)) {
    if (entry.path().extension() == kWork && entry.is_directory(ignored))
      WorkFolder::remove_abandoned(entry.path().string());
    if (entry.path().extension() != ".voy" || !entry.is_regular_file(ignored)) continue;
    files.push_back({entry.path(), entry.last_write_time(ignored), entry.file_size(ignored)});
    sum += files.back().bytes;
  }
  std::sort(files.begin(), files.end(),
            [](const Kept& a, const Kept& b) { return a.time < b.time; });
  for (const Kept& file : files) {
    if (sum <= kLargestCache || file.path == used) break;
    if (fs::remove(file.path, ignored)) sum -= file.bytes;
  }
}

}  // namespace voyager::view
