#include "tools/view/background_bake.h"

#include <unistd.h>

#include "runtime/bake/bake.h"
#include "runtime/base/open_source.h"
#include "runtime/scene/import/block_reader.h"

namespace voyager::view {
namespace {

uint64_t half_of_memory() {
  return static_cast<uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
         static_cast<uint64_t>(::sysconf(_SC_PAGESIZE)) / 2;
}

}  // namespace

void bake_scene(const std::string& scene, const std::string& output, const Progress& progress) {
  BakeInParts bake;
  bake.request = bake_request({scene}, bake.quality, bake.chunk_bytes);
  bake.output = output;
  bake.work = output + ".work";
  bake.temporary = true;
  bake.memory = half_of_memory();
  Workers workers;
  const auto open = [&] {
    std::vector<std::unique_ptr<BlockReader>> readers;
    readers.push_back(open_blocks(open_source(scene)));
    return readers;
  };
  bake_in_parts(bake, open, workers, progress);
}

}  // namespace voyager::view
