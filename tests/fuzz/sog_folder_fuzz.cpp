// A folder with the meta.json or lod-meta.json of a SOG scene as its first file (archive.h).
#include <cstdint>

#include "runtime/base/name_ending.h"
#include "runtime/scene/import/sog/lod_scene.h"
#include "runtime/scene/import/sog/scene.h"
#include "tests/fuzz/memory_folder.h"
#include "tests/fuzz/read_blocks.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace voyager;
  const fuzz::MemoryLimit limit(size);
  const auto source = fuzz::open_archive(std::as_bytes(std::span(data, size)));
  const bool is_streamed = has_ending(source->name(), "lod-meta.json");
  fuzz::expect_same_in_blocks_and_whole(
      [&] { return is_streamed ? sog::open_streamed(source) : sog::open(source); });
  return 0;
}
