#pragma once
// The header of Spark's .rad: which Gaussians there are, and where their chunks begin.
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runtime/base/file.h"

namespace voyager::rad {

// Spark writes 65,536. A chunk is held as a whole.
inline constexpr uint64_t kMostChunkGaussians = 1 << 17;

struct Header {
  uint64_t count = 0;  // nodes of a tree, or Gaussians
  int sh_degree = 0;
  bool is_tree = false;
};

// A chunk's place: `bytes` at `offset` in the file itself, or in one beside it.
struct ChunkPlace {
  uint64_t base = 0, count = 0;  // of all Gaussians
  std::string file;              // beside; empty for the file itself
  uint64_t offset = 0, bytes = 0;
};

struct File {
  Header header;
  std::vector<ChunkPlace> chunks;  // in order, one after the other; no bytes twice
};

// Throws Error(refused_input) naming the field. Places in the file itself are within its size.
File read_header(const ByteSource& source);

// What header and chunks begin with: a mark, the length of a JSON, the JSON, and zeros up to a
// multiple of 8 bytes.
struct Opening {
  nlohmann::json json;
  uint64_t json_offset = 0, end = 0;  // in the source; the end is that of the zeros
};
// `what`, for messages, begins at `offset` and has `bytes`, which lie within the source. Throws
// Error(refused_input).
Opening read_opening(const ByteSource& source, uint64_t offset, uint64_t bytes, const char* mark,
                     uint64_t most_json, const std::string& what);

}  // namespace voyager::rad
