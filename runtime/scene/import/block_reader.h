#pragma once
// A flat scene in blocks, for what is larger than memory: bytes come off the input
// one block after the other, and blocks are decoded by as many threads as there are.
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

class BlockReader;

// Of a block, unless one Gaussian alone has more: a row may be as wide as a header says.
inline constexpr size_t kMostBlockBytes = 16 << 20;

// Some Gaussians as the input has them.
struct RawBlock {
  std::vector<std::byte> bytes;
  size_t count = 0;  // Gaussians; 0 after the last block
  // Of several inputs in one (merged_blocks.h), in place of bytes: which of them, and its block.
  std::shared_ptr<const BlockReader> part;
  std::shared_ptr<const RawBlock> of_part;
};

class BlockReader {
 public:
  virtual ~BlockReader() = default;
  // What the input's header says.
  virtual const std::string& name() const = 0;
  virtual uint64_t count() const = 0;
  virtual int sh_degree() const = 0;
  virtual NativeScale native() const = 0;
  // That all blocks have (GaussianCloud::origin).
  virtual std::array<double, 3> origin() const { return {}; }

  // The next Gaussians, at most `most`, which is at least 1, and of kMostBlockBytes at most. From
  // one thread at a time. Throws Error(refused_input) as the importer of the format does,
  // Error(io).
  virtual RawBlock next(size_t most) = 0;
  // The Gaussians of a block, not yet sanitised; the same words that importing the
  // whole gives. Safe from several threads, also beside next().
  virtual GaussianCloud decode(const RawBlock& block) const = 0;
};

// Reads the header. A .ply, a .splat or a .ksplat from any stream; the others, whose parts are
// apart from one another, only from a source, of which each part is read at a place of its own.
// Throws Error(refused_input) naming place, found and expected, and where a file refers to others
// what open_beside() throws.
std::unique_ptr<BlockReader> open_blocks(std::unique_ptr<ByteReader> reader);
std::unique_ptr<BlockReader> open_blocks(std::shared_ptr<const ByteSource> source);

// The formats; the reader stands at the format's first byte.
std::unique_ptr<BlockReader> open_ply_blocks(std::unique_ptr<ByteReader> reader);
std::unique_ptr<BlockReader> open_ply_blocks(std::shared_ptr<const ByteSource> source);
// Needs a reader that knows its length.
std::unique_ptr<BlockReader> open_splat_blocks(std::unique_ptr<ByteReader> reader);
std::unique_ptr<BlockReader> open_ksplat_blocks(std::unique_ptr<ByteReader> reader);
// SOG: a .sog or the meta.json of a folder; and the finest level of a streamed scene's
// lod-meta.json. Their images are decoded before the first block, those of a streamed scene file by
// file. Throw Error(unsupported) where libvoyager_sog.so is missing.
std::unique_ptr<BlockReader> open_sog_blocks(std::shared_ptr<const ByteSource> source);
std::unique_ptr<BlockReader> open_streamed_sog_blocks(std::shared_ptr<const ByteSource> source);
std::unique_ptr<BlockReader> open_spz_blocks(std::shared_ptr<const ByteSource> source);
// What of a .spz is not read, for people: SH of degree 4, and extensions. Throws as its reader
// does.
std::vector<std::string> left_out_of_spz(const ByteSource& source);
// The same of all .spz in a .glb, a .gltf or a tileset, each thing once with how many have it.
std::vector<std::string> left_out_of_gltf(std::shared_ptr<const ByteSource> source);
std::unique_ptr<BlockReader> open_glb_blocks(std::shared_ptr<const ByteSource> source);
// HierarchicalGS's .hier: the leaves of its tree, in the order of the file's Gaussians. Holds the
// links of the tree until it has read them, then 4 bytes a leaf.
std::unique_ptr<BlockReader> open_hier_blocks(std::shared_ptr<const ByteSource> source);
// The .lcc of an LCC scene, whose other files are beside it: its finest level of detail, then its
// environment. Holds 32 bytes a cell.
std::unique_ptr<BlockReader> open_lcc_blocks(std::shared_ptr<const ByteSource> source);
// What of it is not read, for people. Throws as its reader does.
std::vector<std::string> left_out_of_lcc(const ByteSource& source);
// Spark's .rad without tables of SH: its Gaussians, or the leaves of its tree. Reads the tree's
// numbers of children before the first block, and holds a chunk at a time.
std::unique_ptr<BlockReader> open_rad_blocks(std::shared_ptr<const ByteSource> source);
// A .gltf, or the tileset.json of 3D Tiles.
std::unique_ptr<BlockReader> open_json_blocks(std::shared_ptr<const ByteSource> source);

}  // namespace voyager
