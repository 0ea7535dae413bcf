#pragma once
// The header of a .spz, and for version 4 its table of streams.
#include <array>

#include "runtime/scene/import/peek_reader.h"
#include "runtime/scene/native_scale.h"
#include "runtime/scene/spz_format.h"

namespace voyager::spz {

// Versions: the newest that is one gzip stream, and the newest.
inline constexpr uint32_t kNewestPlanar = 3, kNewest = 4;

struct Header {
  uint32_t version = 0, count = 0;
  int sh_degree = 0, fractional_bits = 0;
  bool antialiased = false, has_extensions = false;
  uint8_t last = 0;  // v1-v3: reserved; v4: number of streams

  NativeScale native() const { return antialiased ? compensated_scale(kLowPass) : NativeScale{}; }
  size_t bytes_of(Attribute attribute) const { return width(attribute, version, sh_degree); }
  // The attributes that are present are the first so many.
  int attributes() const { return sh_degree > 0 ? kAttributes : kSh; }
};

// Reads the 16 bytes that all versions share, refusing what is out of range.
Header read_header(ByteReader& plain, uint32_t newest_version);

// Refuses more Gaussians than a file of that length is worth. `input` is the file, compressed as it
// is; nothing is said of a stream whose length is not known.
void check_count(const PeekReader& input, const Header& header);

// Compressed size of each stream of a version 4, whose header's first 16 bytes
// were read; leaves `input` at the first stream.
std::array<uint64_t, kAttributes> read_stream_table(PeekReader& input, const Header& header);

}  // namespace voyager::spz
