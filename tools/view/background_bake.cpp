#include "tools/view/background_bake.h"

#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>

#include "runtime/bake/bake.h"
#include "runtime/base/open_source.h"
#include "runtime/base/owned_folder.h"
#include "runtime/scene/import/block_reader.h"
#include "tools/view/bake_cache.h"

namespace voyager::view {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kBetweenLooks{100};  // at a folder that another process has

uint64_t half_of_memory() {
  return static_cast<uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
         static_cast<uint64_t>(::sysconf(_SC_PAGESIZE)) / 2;
}

// Of a file that is replaced in one step; nothing where there is none.
std::optional<fs::file_time_type> time_of(const std::string& file) {
  std::error_code no_file;
  const auto time = fs::last_write_time(file, no_file);
  if (no_file) return std::nullopt;
  return time;
}

}  // namespace

void bake_scene(const std::string& scene, const std::string& output, const Progress& progress) {
  const auto before = time_of(output);
  BakeInParts bake;
  bake.request = bake_request({scene}, bake.quality, bake.chunk_bytes);
  bake.output = output;
  bake.work = work_folder(output);
  bake.temporary = true;
  bake.memory = half_of_memory();
  Workers workers;
  const auto open = [&] {
    std::vector<std::unique_ptr<BlockReader>> readers;
    readers.push_back(open_blocks(open_source(scene)));
    return readers;
  };
  while (time_of(output) == before) try {
      bake_in_parts(bake, open, workers, progress);
      return;
    } catch (const FolderTaken&) {
      progress("waiting for another viewer's bake", 0, 0);
      std::this_thread::sleep_for(kBetweenLooks);
    }
}

}  // namespace voyager::view
