// Any bytes as the lod-meta.json of a streamed SOG scene: parts that share no Gaussian, or a
// refusal.
#include <cstdint>

#include "runtime/scene/import/sog/lod_meta.h"
#include "tests/fuzz/import_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace voyager;
  const fuzz::MemoryLimit limit(size);
  const MemorySource source("lod-meta.json", std::as_bytes(std::span(data, size)));
  fuzz::unless_refused([&] {
    const std::vector<sog::Part> parts = sog::finest_level(source);
    for (size_t i = 1; i < parts.size(); ++i)
      if (parts[i - 1].file == parts[i].file && parts[i].count != UINT64_MAX &&
          parts[i - 1].first + parts[i - 1].count >= parts[i].first)
        std::abort();
    return GaussianCloud();
  });
  return 0;
}
