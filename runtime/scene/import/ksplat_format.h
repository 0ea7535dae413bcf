#pragma once
// mkkellogg's .ksplat, version 0.1, little-endian: a header, a header for each section, then the
// sections one after the other. A section is the lengths of its partly filled buckets, the centres
// of its buckets, then a row for each Gaussian.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/base/file.h"

namespace voyager::ksplat {

// How much each value is compressed by.
enum class Level { floats = 0, halves = 1, halves_and_bytes = 2 };  // SH bands: bytes in the last

struct Section {
  uint64_t count = 0;  // Gaussians
  uint64_t rows = 0;   // at least as many; those beyond the count are unused
  uint64_t bucket_size = 0, buckets = 0, full_buckets = 0, partial_buckets = 0;
  uint64_t centre_bytes = 0;    // of a bucket: three floats first
  float bucket_width = 0;       // metres
  uint32_t position_steps = 0;  // codes on either side of a bucket's centre
  int sh_degree = 0;
};

struct Header {
  Level level = Level::floats;
  uint64_t count = 0;
  float sh_least = 0, sh_most = 0;  // of byte codes
  std::vector<Section> sections;

  bool compressed() const { return level != Level::floats; }
  size_t row_bytes(const Section& section) const;
  uint64_t bytes_of(const Section& section) const;
  int sh_degree() const;  // the highest of a section
};

// Leaves `input` at the first section. Refuses what is out of range, and, where the length of the
// stream is known, sections that do not fill it.
Header read_header(ByteReader& input);

}  // namespace voyager::ksplat
