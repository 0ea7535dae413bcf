// Any bytes given as a .voy file: opened, every chunk read, loaded as a scene.
// Checksums would stop nearly every mutation at the door, so that the same
// bytes are tried again with the checksums made right.
#include <algorithm>
#include <cstring>
#include <vector>

#include "runtime/base/checksum.h"
#include "runtime/base/error.h"
#include "runtime/format/reader.h"
#include "runtime/frame/scene.h"

namespace voyager {
namespace {

using Bytes = std::vector<std::byte>;

void seal_chunks(Bytes& bytes, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i) {
    const size_t at = sizeof(FileHeader) + i * sizeof(ChunkEntry);
    if (at + sizeof(ChunkEntry) > bytes.size()) return;
    ChunkEntry entry;
    std::memcpy(&entry, bytes.data() + at, sizeof entry);
    if (entry.offset > bytes.size() || entry.bytes > bytes.size() - entry.offset) return;
    entry.checksum = checksum(std::span(bytes).subspan(entry.offset, entry.bytes));
    std::memcpy(bytes.data() + at, &entry, sizeof entry);
  }
}

Bytes sealed(Bytes bytes) {
  FileHeader header;
  if (bytes.size() < sizeof header) return bytes;
  std::memcpy(&header, bytes.data(), sizeof header);
  header.file_length = bytes.size();
  seal_chunks(bytes, header.chunk_count);
  const Section& directory = header.directory;
  if (directory.offset <= bytes.size() && directory.length <= bytes.size() - directory.offset)
    header.directory.checksum =
        checksum(std::span(bytes).subspan(directory.offset, directory.length));
  header.checksum =
      checksum(std::as_bytes(std::span(&header, 1)).first(offsetof(FileHeader, checksum)));
  std::memcpy(bytes.data(), &header, sizeof header);
  return bytes;
}

void read_all(const Bytes& bytes) {
  static Workers workers(1);
  const auto source = std::make_shared<MemorySource>("fuzz.voy", bytes);
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
}  // namespace voyager

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  const voyager::Bytes input(first, first + size);
  voyager::read_all(input);
  voyager::read_all(voyager::sealed(input));
  return 0;
}
