// Any bytes given as a .voy file: opened, every chunk read, loaded as a scene.
// Checksums would stop nearly every mutation at the door, so that the same
// bytes are tried again with the checksums made right.
#include "runtime/base/error.h"
#include "runtime/format/reader.h"
#include "runtime/frame/scene.h"
#include "tests/fuzz/memory_limit.h"
#include "tests/support/sealed.h"

namespace voyager::fuzz {
namespace {

using test::Bytes;

void read_all(const Bytes& bytes) {
  static Workers workers(1);
  const auto source = std::make_shared<MemorySource>("fuzz.voy", bytes);
  const MemoryLimit limit(bytes.size());
  try {
    const SceneFile file(source);
    for (uint32_t i = 0; i < file.chunks().size(); ++i) {
      try {
        file.read_chunk(i);
      } catch (const Error&) {
        continue;  // the other chunks are still to be read
      }
    }
    load_scene(source, std::pmr::get_default_resource(), workers);
  } catch (const Error&) {
    return;  // a refusal is a right answer; anything else ends the run
  }
}

}  // namespace
}  // namespace voyager::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  const voyager::test::Bytes input(first, first + size);
  voyager::fuzz::read_all(input);
  voyager::fuzz::read_all(voyager::test::sealed(input));
  return 0;
}
