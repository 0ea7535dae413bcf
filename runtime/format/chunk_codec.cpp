#include "runtime/format/chunk_codec.h"

#include <algorithm>
#include <cstring>

#include "runtime/base/checksum.h"
#include "runtime/base/error.h"
#include "runtime/format/check_chunk.h"
#include "runtime/format/chunk_directory.h"
#include "runtime/format/compact_codec.h"
#include "runtime/format/lossless_codec.h"
#include "runtime/scene/sh_bands.h"

namespace voyager {
namespace {

void check_field(const ChunkLocation& location, const char* field, uint64_t found,
                 uint64_t expected) {
  if (found != expected)
    location.damaged(std::string(field) + " " + std::to_string(found), std::to_string(expected));
}

bool sound_scales(const ChunkHeader& header) {
  // Written so that a NaN fails.
  for (int axis = 0; axis < 3; ++axis)
    if (!(header.position_step[axis] >= 0 && header.position_step[axis] < double{kMaxCoordinate}))
      return false;
  for (const float scale : header.sh_scale)
    if (!(scale >= 0 && scale <= std::numeric_limits<float>::max())) return false;
  return true;
}

ChunkHeader checked_header(std::span<const std::byte> bytes, const ChunkLocation& location,
                           const ChunkContext& context) {
  const ChunkEntry& entry = location.entry;
  const uint64_t alignment = chunk_align(context.quality);
  ChunkHeader header;
  check_field(location, "stored length", bytes.size(),
              align_up(std::max(bytes.size(), sizeof header), alignment));
  std::memcpy(&header, bytes.data(), sizeof header);
  check_field(location, "tag", header.tag, kChunkTag);
  check_field(location, "first subtree", header.first_subtree, entry.first_subtree);
  check_field(location, "subtree count", header.subtree_count, entry.subtree_count);
  check_field(location, "node count", header.node_count, entry.node_count);
  check_field(location, "record count", header.record_count, entry.record_count);
  check_field(location, "quality", header.quality, static_cast<uint32_t>(context.quality));
  if (header.sh_degree > context.sh_degree)
    location.damaged("SH degree " + std::to_string(header.sh_degree),
                     "at most the file's " + std::to_string(context.sh_degree));
  check_field(location, "stored length", bytes.size(),
              align_up(sizeof header + uint64_t{header.payload_bytes}, alignment));
  if (context.quality == Quality::lossless)
    check_field(
        location, "payload length", header.payload_bytes,
        lossless_payload_bytes(entry, static_cast<size_t>(sh_coefficients(header.sh_degree)),
                               context.version));
  if (!sound_scales(header))
    location.damaged("a position step or SH scale out of range", "finite values");
  return header;
}

}  // namespace

void ChunkLocation::damaged(const std::string& found, const std::string& expected) const {
  throw Error(ErrorCode::damaged_chunk, file + ": chunk " + std::to_string(index) + " at offset " +
                                            std::to_string(entry.offset) + ": found " + found +
                                            ", expected " + expected);
}

namespace {

EncodedChunk encode_bands(const Chunk& chunk, const ChunkContext& context) {
  ChunkHeader header{};
  header.tag = kChunkTag;
  header.first_subtree = chunk.first_subtree;
  header.subtree_count = static_cast<uint32_t>(chunk.subtrees.size());
  header.node_count = static_cast<uint32_t>(chunk.words.size());
  header.record_count = static_cast<uint32_t>(chunk.records.size());
  header.quality = static_cast<uint16_t>(context.quality);
  header.sh_degree = static_cast<uint16_t>(context.sh_degree);
  EncodedChunk out;
  out.leaves_have_extent =
      std::any_of(chunk.records.begin(), chunk.records.end(),
                  [](const NodeRecord& r) { return r.child_count == 0 && r.extent != 0; });
  out.bytes.resize(sizeof header);
  if (context.quality == Quality::compact)
    encode_compact(chunk, context, header, out);
  else
    encode_lossless(chunk, context, out);
  header.payload_bytes = static_cast<uint32_t>(out.bytes.size() - sizeof header);
  std::memcpy(out.bytes.data(), &header, sizeof header);
  out.bytes.resize(align_up(out.bytes.size(), chunk_align(context.quality)));
  out.checksum = checksum(out.bytes);
  return out;
}

// The file's, but with the bands that the chunk has.
ChunkContext context_of(int sh_degree, const ChunkContext& file) {
  ChunkContext own = file;
  own.sh_degree = sh_degree;
  return own;
}

}  // namespace

EncodedChunk encode_chunk(const Chunk& chunk, const ChunkContext& context) {
  const int stored = stored_sh_degree(chunk.sh, context.sh_degree);
  if (stored == context.sh_degree) return encode_bands(chunk, context);
  Chunk lower = chunk;
  change_sh_degree(lower.sh, context.sh_degree, stored);
  return encode_bands(lower, context_of(stored, context));
}

Chunk decode_chunk(std::span<const std::byte> bytes, const ChunkLocation& location,
                   const ChunkContext& context) {
  check_field(location, "checksum", kept_checksum(checksum(bytes)),
              kept_checksum(location.entry.checksum));
  const ChunkHeader header = checked_header(bytes, location, context);
  const std::span<const std::byte> payload = bytes.subspan(sizeof header, header.payload_bytes);
  const std::span<const std::byte> padding = bytes.subspan(sizeof header + header.payload_bytes);
  if (std::any_of(padding.begin(), padding.end(), [](std::byte b) { return b != std::byte{0}; }))
    location.damaged("padding that is not 0", "zeros");
  const ChunkContext own = context_of(header.sh_degree, context);
  Chunk chunk;
  chunk.first_subtree = header.first_subtree;
  chunk.linear_leaves = context.linear_leaves;
  if (context.quality == Quality::compact)
    decode_compact(payload, header, location, own, chunk);
  else
    decode_lossless(payload, location, own, chunk);
  change_sh_degree(chunk.sh, own.sh_degree, context.sh_degree);
  check_words(chunk, location, context);
  if (context.quality == Quality::compact) round_means(chunk);
  return chunk;
}

}  // namespace voyager
