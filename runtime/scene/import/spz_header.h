#pragma once
// The header of a .spz, and for version 4 its table of streams.
#include <array>

#include "runtime/scene/import/peek_reader.h"
#include "runtime/scene/import/spz_extensions.h"
#include "runtime/scene/native_scale.h"
#include "runtime/scene/spz_format.h"

namespace voyager::spz {

// Versions: the newest that is one gzip stream, and the newest.
inline constexpr uint32_t kNewestPlanar = 3, kNewest = 4;

struct Header {
  uint32_t version = 0, count = 0;
  int sh_degree = 0;         // that is read, at most kMaxShDegree
  int stored_sh_degree = 0;  // that the file has: bands above are stepped over
  int fractional_bits = 0;
  bool antialiased = false, has_extensions = false;
  uint8_t last = 0;              // v1-v3: reserved; v4: number of streams
  HalfTurn to_inria = kToInria;  // from the axes that the numbers are taken to have

  NativeScale native() const { return antialiased ? compensated_scale(kLowPass) : NativeScale{}; }
  size_t bytes_of(Attribute attribute) const { return width(attribute, version, stored_sh_degree); }
  uint64_t bytes_of_all(Attribute attribute) const { return uint64_t{count} * bytes_of(attribute); }
  // The attributes that are present are the first so many.
  int attributes() const { return stored_sh_degree > 0 ? kAttributes : kSh; }
};
inline constexpr int kMostStoredShDegree = 4;

// Reads the 16 bytes that all versions share, refusing what is out of range.
Header read_header(ByteReader& plain, uint32_t newest_version);

// Refuses more Gaussians than a file of that length is worth, and than its bytes can hold however
// they are compressed. `input` is the file, compressed as it is; nothing is said of a stream whose
// length is not known.
void check_count(const PeekReader& input, const Header& header, bool gzipped);

// What a version 4 has before its streams.
struct StreamTable {
  std::array<uint64_t, kAttributes> compressed{};  // size of each
  Extensions extensions;
};
// The header's first 16 bytes were read; leaves `input` at the first stream.
StreamTable read_stream_table(PeekReader& input, const Header& header);

// Of versions 1 to 3, after the last attribute: reads to the end, and refuses more than
// kMostExtensionBytes.
Extensions read_last_extensions(ByteReader& plain, const Header& header);

// Of a whole file. What stands before extensions is decompressed for it.
struct Announcement {
  Header header;
  Extensions extensions;
};
Announcement read_announcement(const ByteSource& source);

}  // namespace voyager::spz
