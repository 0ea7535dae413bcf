// The reader itself, which a program that is not fuzzed loads as a module.
#include <cstdint>

#include "runtime/scene/import/sog/scene.h"
#include "tests/fuzz/import_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace voyager;
  const auto bytes = std::as_bytes(std::span(data, size));
  const fuzz::MemoryLimit limit(size);
  const auto source = std::make_shared<MemorySource>("fuzz.sog", bytes);
  const auto whole = fuzz::unless_refused([&] { return import_gaussians(*sog::open(source)); });
  if (whole && !fuzz::is_complete(*whole)) std::abort();
  fuzz::unless_refused([&] {
    fuzz::read_small_blocks(*sog::open(source));
    return GaussianCloud();
  });
  return 0;
}
