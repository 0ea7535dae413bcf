#pragma once
// A chunk of a .rad: its header, and the plain bytes of its properties.
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/scene/import/rad/header.h"
#include "runtime/scene/import/rad/property.h"

namespace voyager::rad {

struct Chunk {
  std::shared_ptr<const ByteSource> source;
  uint64_t payload = 0;  // where it begins
  uint64_t count = 0;    // Gaussians
  Properties properties;
};

// `rad` is the .rad, `place` of its header. Throws Error(refused_input), and for a file beside it
// what open_beside() throws.
Chunk open_chunk(const std::shared_ptr<const ByteSource>& rad, const Header& header,
                 const ChunkPlace& place);

// The planes of a property, decompressed, with differences added up: a property of r8_delta is then
// one of r8. Throws Error(refused_input) unless it has a number for each Gaussian and no more.
std::vector<std::byte> read_plain(const Chunk& chunk, const Property& property);

// The Gaussians of a tree that have no children, in order. Throws as read_plain() does.
std::vector<uint32_t> leaves_of(const Chunk& chunk);

}  // namespace voyager::rad
