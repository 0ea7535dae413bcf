// Any bytes of a .glb, a .gltf or a tileset: in blocks of any size the same words to the bit, or a
// refusal; and as a whole a sound cloud.
#include <cstdint>

#include "tests/fuzz/read_blocks.h"

namespace voyager::fuzz {
namespace {

constexpr uint64_t kMost = 1000;  // Gaussians: more take long, and say nothing new

// 0 where the input is refused.
template <class Open>
uint64_t announced(const Open& open) {
  uint64_t count = 0;
  unless_refused([&] {
    count = open()->count();
    return GaussianCloud();
  });
  return count;
}

void read_all_ways(std::span<const std::byte> bytes) {
  const MemoryLimit limit(bytes.size());
  const auto source = std::make_shared<MemorySource>("fuzz", bytes);
  const bool binary = !bytes.empty() && bytes[0] == std::byte{'g'};
  const auto open = [&] { return binary ? open_glb_blocks(source) : open_json_blocks(source); };
  if (announced(open) > kMost) return;
  const auto whole = unless_refused([&] { return read_blocks(*open(), 5000); });
  expect_same(whole, unless_refused([&] { return read_blocks(*open(), 3); }));
  const auto sound = unless_refused([&] { return import_gaussians(*open()); });
  if (sound.has_value() != whole.has_value() || (sound && !is_complete(*sound))) std::abort();
}

}  // namespace
}  // namespace voyager::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  voyager::fuzz::read_all_ways(std::as_bytes(std::span(data, size)));
  return 0;
}
