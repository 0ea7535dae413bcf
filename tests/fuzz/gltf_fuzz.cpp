// Any bytes of a .glb, a .gltf or a tileset: in blocks of any size the same words to the bit, or a
// refusal; and as a whole a sound cloud.
#include <cstdint>

#include "tests/fuzz/read_blocks.h"

namespace voyager::fuzz {
namespace {

void read_gltf(std::span<const std::byte> bytes) {
  const MemoryLimit limit(bytes.size());
  const auto source = std::make_shared<MemorySource>("fuzz", bytes);
  const bool binary = !bytes.empty() && bytes[0] == std::byte{'g'};
  const auto open = [&] { return binary ? open_glb_blocks(source) : open_json_blocks(source); };
  expect_same_in_blocks_and_whole(open);
}

}  // namespace
}  // namespace voyager::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  voyager::fuzz::read_gltf(std::as_bytes(std::span(data, size)));
  return 0;
}
