// A folder with a .rad as its first file, and the files of its chunks beside it (archive.h).
#include <cstdint>

#include "tests/fuzz/memory_folder.h"
#include "tests/fuzz/read_blocks.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace voyager;
  const fuzz::MemoryLimit limit(size);
  const auto source = fuzz::open_archive(std::as_bytes(std::span(data, size)));
  fuzz::expect_same_in_blocks_and_whole([&] { return open_rad_blocks(source); });
  return 0;
}
