#pragma once
#include <vector>

#include "runtime/format/chunk_directory.h"
#include "runtime/format/refusal.h"

namespace voyager {

// What lies between the header and the first chunk.
struct FileSections {
  std::vector<uint32_t> level_begin, tier_begin;  // as in Partition
  ChunkDirectory chunks;
};

// Checked so far that every entry's place is one that a SubtreeCursor can move to,
// that chunks follow one another without a gap in bytes, subtrees and nodes, and
// that no chunk holds more than the header's chunk_bytes. Throws Error(refused_input).
FileSections read_sections(const ByteSource& source, const FileHeader& header, const Check& check);

}  // namespace voyager
