#include <cstdint>

#include "tests/fuzz/import_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  voyager::fuzz::import_named("fuzz.splat", std::as_bytes(std::span(data, size)));
  return 0;
}
