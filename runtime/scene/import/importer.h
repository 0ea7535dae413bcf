#pragma once
// The room for formats. A format is one file here with one entry in the table
// of importer.cpp.
#include <memory>
#include <memory_resource>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/base/progress.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

struct ImportOptions {
  std::pmr::memory_resource* memory = std::pmr::get_default_resource();
  Progress progress;  // stage "reading"
};

class BlockReader;

// Reads a flat scene, in whichever known format the end of its name or its first bytes say it is,
// and sanitises it. Throws Error(refused_input) naming file, offset or field, what was found and
// what was expected; allocates only as bytes arrive. SH bands that are zero everywhere are left
// out. A source has every format; a stream those that are read from their start to their end. From
// blocks: what the reader has from where it stands.
GaussianCloud import_gaussians(ByteReader& reader, const ImportOptions& options = {});
GaussianCloud import_gaussians(std::shared_ptr<const ByteSource> source,
                               const ImportOptions& options = {});
GaussianCloud import_gaussians(BlockReader& reader, const ImportOptions& options = {});

// True if a file of that name with those first bytes (kFormatBytes of them, or all that there are)
// is of a format that import_gaussians reads.
inline constexpr size_t kFormatBytes = 4;
bool is_importable(std::span<const std::byte> first_bytes, std::string_view name);

// What the format's reader leaves out of the file, for people, such as extensions of a .spz:
// nothing for most. Throws Error(refused_input) as the reader does.
std::vector<std::string> left_out_of(const ByteSource& source);

// True for the names of HierarchicalGS's trees, whose first bytes say nothing: they end in .hier or
// .hier_opt, in any case.
bool is_hier_name(std::string_view name);

// For the message that refuses a file: the formats and how each is told, and, where it is one that
// is known and not read, why.
std::string expected_format(std::span<const std::byte> first_bytes, std::string_view name);

// The formats that may be streams; `reader` stands at the format's first byte. Both deliver words
// as the file has them, not yet sanitised. A file must end where its header
// says: bytes after that mean that header and body disagree, and are refused.
//
// .ply: any property order and scalar type, little- or big-endian; other
// elements are skipped. With double x, y, z the first finite vertex chooses the
// cloud's origin: per axis 0 within 16 km, else the nearest multiple of 1024 m. A list property in
// or before the vertex element, the ASCII encoding, a count of f_rest_* other than 0, 9, 24 or 45
// and 2DGS are refused. PlayCanvas's .compressed.ply is told by its properties.
GaussianCloud import_ply(ByteReader& reader, const ImportOptions& options);
// .spz versions 1 to 4, gzipped or (a raw v1-v3) not; SH degree 0 to 4, of which 3 are read. Of the
// extensions the coordinate system is read, others are skipped; unknown flags, which may change the
// layout, and non-zero reserved bytes are refused.
GaussianCloud import_spz(ByteReader& reader, const ImportOptions& options);

}  // namespace voyager
