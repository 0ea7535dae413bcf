#pragma once
// A .voy file whose values were changed, under checksums that are right.
#include <cstring>
#include <span>
#include <vector>

#include "runtime/base/checksum.h"
#include "runtime/format/layout.h"

namespace voyager::test {

using Bytes = std::vector<std::byte>;

// The checksum of further Gaussians, the file's last 8 bytes.
inline void seal_further(Bytes& bytes, uint64_t begin) {
  if (begin > bytes.size() || bytes.size() - begin < sizeof(uint64_t)) return;
  const size_t end = bytes.size() - sizeof(uint64_t);
  const uint64_t sum = checksum(std::span<const std::byte>(bytes).subspan(begin, end - begin));
  std::memcpy(bytes.data() + end, &sum, sizeof sum);
}

// The checksums of all chunks, sections and the header made right again; bytes whose
// places make no sense are left as they are.
inline Bytes sealed(Bytes bytes) {
  FileHeader header;
  if (bytes.size() < sizeof header) return bytes;
  std::memcpy(&header, bytes.data(), sizeof header);
  header.file_length = bytes.size();
  const auto in_file = [&](uint64_t offset, uint64_t length) {
    return offset <= bytes.size() && length <= bytes.size() - offset;
  };
  const auto sum = [&](uint64_t offset, uint64_t length) {
    return checksum(std::span<const std::byte>(bytes).subspan(offset, length));
  };
  uint64_t end_of_chunks = bytes.size();
  for (uint64_t i = 0; i < header.chunk_count; ++i) {
    const uint64_t at = header.directory.offset + i * sizeof(ChunkEntry);
    ChunkEntry entry;
    if (!in_file(at, sizeof entry)) break;
    std::memcpy(&entry, bytes.data() + at, sizeof entry);
    if (!in_file(entry.offset, entry.bytes)) break;
    end_of_chunks = entry.offset + entry.bytes;
    entry.checksum = sum(entry.offset, entry.bytes);
    std::memcpy(bytes.data() + at, &entry, sizeof entry);
  }
  if ((header.flags & kFlagFurther) != 0) seal_further(bytes, end_of_chunks);
  for (Section* section : {&header.directory, &header.tiers})
    if (in_file(section->offset, section->length))
      section->checksum = sum(section->offset, section->length);
  header.checksum =
      checksum(std::as_bytes(std::span(&header, 1)).first(offsetof(FileHeader, checksum)));
  std::memcpy(bytes.data(), &header, sizeof header);
  return bytes;
}

}  // namespace voyager::test
