// An LCC scene of XGRIDS: a .lcc, and beside it index.bin, data.bin, shcoef.bin where it has SH
// bands, and environment.bin where it has surroundings, which belong to all levels of detail.
#include <cctype>
#include <utility>

#include "runtime/math/affine.h"
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/lcc/rows.h"
#include "runtime/scene/import/merged_blocks.h"
#include "runtime/scene/import/placed_blocks.h"
#include "runtime/scene/import/refuse.h"

namespace voyager::lcc {
namespace {

using Source = std::shared_ptr<const ByteSource>;

// Scenes have index.bin; the format's description says Index.bin. Null where neither is there.
Source find_beside(const ByteSource& lcc, std::string name) {
  for (const bool is_capital : {false, true}) {
    if (is_capital) name[0] = static_cast<char>(std::toupper(name[0]));
    try {
      return lcc.open_beside(name);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::file_not_found) throw;
    }
  }
  return nullptr;
}

Source require_beside(const ByteSource& lcc, const std::string& name) {
  Source source = find_beside(lcc, name);
  if (!source) refuse(lcc.name(), 0, name, "no such file", "one beside the .lcc");
  return source;
}

Bounds require_bounds(const ByteSource& lcc, const std::optional<Bounds>& bounds,
                      const std::string& attribute) {
  if (!bounds) refuse(lcc.name(), 0, "attributes", "no " + attribute, "one");
  return *bounds;
}

// Before version 4 the file alone tells whether there are SH bands.
Source find_sh(const ByteSource& lcc, const std::optional<bool>& has_sh) {
  if (!has_sh) return find_beside(lcc, "shcoef.bin");
  return *has_sh ? require_beside(lcc, "shcoef.bin") : nullptr;
}

Rows rows_of_data(const ByteSource& lcc, const Meta& meta) {
  Rows rows;
  rows.file = require_beside(lcc, "data.bin");
  rows.sh_file = find_sh(lcc, meta.has_sh);
  rows.scale = require_bounds(lcc, meta.scale, "scale");
  rows.ranges = finest_level(*require_beside(lcc, "index.bin"), meta.levels, rows.file->size());
  if (!rows.sh_file) return rows;
  rows.sh = require_bounds(lcc, meta.sh, "shcoef");
  const uint64_t expected = kShRowBytes / kRowBytes * rows.file->size();
  if (rows.sh_file->size() < expected)
    refuse(rows.sh_file->name(), 0, "length", std::to_string(rows.sh_file->size()) + " bytes",
           std::to_string(expected) + ", twice those of data.bin");
  return rows;
}

Rows rows_of_environment(const ByteSource& lcc, Source file, const Meta& meta, bool has_sh) {
  Rows rows;
  rows.file = std::move(file);
  rows.scale = require_bounds(lcc, meta.environment_scale, "envscale");
  if (has_sh) rows.sh = require_bounds(lcc, meta.environment_sh, "envshcoef");
  const uint64_t size = rows.file->size(), row = rows.row_bytes();
  if (size == 0 || size % row != 0)
    refuse(rows.file->name(), 0, "length", std::to_string(size) + " bytes",
           "a multiple of the " + std::to_string(row) + " of a Gaussian, and not 0");
  rows.ranges = {{0, size / row}};
  return rows;
}

BlockPart part_of(Rows rows) {
  BlockPart part{rows.count(), rows.sh_degree(), {}, {}};
  part.open = [rows = std::move(rows)] { return std::shared_ptr(open_rows(rows)); };
  return part;
}

std::unique_ptr<BlockReader> open(const ByteSource& lcc) {
  const Meta meta = read_meta(lcc);
  Rows data = rows_of_data(lcc, meta);
  const bool has_sh = data.sh.has_value();
  std::vector<BlockPart> parts;
  parts.push_back(part_of(std::move(data)));
  if (Source environment = find_beside(lcc, "environment.bin"))
    parts.push_back(part_of(rows_of_environment(lcc, std::move(environment), meta, has_sh)));
  return place_blocks(merge_blocks(lcc.name(), std::move(parts), {}), {kFromZUp, {}}, {},
                      lcc.name());
}

}  // namespace
}  // namespace voyager::lcc

namespace voyager {

// The table of formats has one signature for all.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
std::unique_ptr<BlockReader> open_lcc_blocks(std::shared_ptr<const ByteSource> source) {
  return lcc::open(*source);
}

std::vector<std::string> left_out_of_lcc(const ByteSource& source) {
  if (lcc::read_meta(source).is_on_earth) return {"the scene's place on Earth (offset)"};
  return {};
}

}  // namespace voyager
