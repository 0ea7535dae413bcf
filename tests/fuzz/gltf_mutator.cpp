// Mutates what a .glb or .gltf says.
#include "tests/fuzz/json_mutation.h"

size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned int seed) {
  using namespace voyager::fuzz;
  Random random(seed);
  const auto* first = reinterpret_cast<const std::byte*>(data);
  Bytes bytes(first, first + size);
  if (random.once_in(8) || !mutate_gltf(bytes, random)) mutate(bytes, max_size);
  return hand_back(bytes, data, size, max_size);
}
