#pragma once
// Gaussians of an LCC scene, row by row as its files have them, in its own axes: x right,
// y forward, z up.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/lcc/index.h"
#include "runtime/scene/import/lcc/meta.h"

namespace voyager::lcc {

// The rows of data.bin, whose SH bands are in a file of their own, or of environment.bin, where
// they follow each row.
struct Rows {
  std::shared_ptr<const ByteSource> file;
  std::shared_ptr<const ByteSource> sh_file;  // row for row as `file`; null where there is none
  std::vector<Range> ranges;                  // inside both files
  Bounds scale;
  std::optional<Bounds> sh;  // nothing: degree 0

  uint64_t count() const;
  int sh_degree() const { return sh ? 3 : 0; }
  // Of a Gaussian in `file`.
  uint64_t row_bytes() const { return kRowBytes + (sh && !sh_file ? kShRowBytes : 0); }
};

std::unique_ptr<BlockReader> open_rows(Rows rows);

}  // namespace voyager::lcc
