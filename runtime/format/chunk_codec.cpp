#include "runtime/format/chunk_codec.h"

#include <cstring>

#include "runtime/base/checksum.h"
#include "runtime/base/error.h"
#include "runtime/format/check_chunk.h"
#include "runtime/format/compact_codec.h"
#include "runtime/format/lossless_codec.h"

namespace voyager {
namespace {

void check_field(const ChunkPlace& place, const char* field, uint64_t found, uint64_t expected) {
  if (found != expected)
    place.damaged(std::string(field) + " " + std::to_string(found), std::to_string(expected));
}

bool sound_frame(const ChunkHeader& header) {
  // Written so that a NaN fails.
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::fabs(header.position_min[axis]) < double{kMaxCoordinate}) ||
        !(header.position_step[axis] >= 0 && header.position_step[axis] < double{kMaxCoordinate}))
      return false;
  for (const float scale : header.sh_scale)
    if (!(scale >= 0 && scale <= std::numeric_limits<float>::max())) return false;
  return true;
}

ChunkHeader checked_header(std::span<const std::byte> bytes, const ChunkPlace& place,
                           const ChunkContext& context) {
  ChunkHeader header;
  check_field(place, "stored length", bytes.size(),
              align_to_chunk(std::max(bytes.size(), sizeof header)));
  std::memcpy(&header, bytes.data(), sizeof header);
  check_field(place, "tag", header.tag, kChunkTag);
  check_field(place, "first node", header.first_node, place.first_node);
  check_field(place, "node count", header.node_count, place.node_count);
  check_field(place, "first child", header.first_child, place.first_child);
  check_field(place, "quality", header.quality, static_cast<uint32_t>(context.quality));
  check_field(place, "SH degree", header.sh_degree, static_cast<uint64_t>(context.sh_degree));
  check_field(place, "reserved field", header.reserved | header.reserved2, 0);
  check_field(place, "stored length", bytes.size(),
              align_to_chunk(sizeof header + uint64_t{header.payload_bytes}));
  if (context.quality == Quality::lossless)
    check_field(place, "payload length", header.payload_bytes,
                lossless_payload_bytes(place.node_count, context.coefficients()));
  if (!sound_frame(header))
    place.damaged("a position frame or SH scale out of range", "finite values");
  return header;
}

}  // namespace

void ChunkPlace::damaged(const std::string& found, const std::string& expected) const {
  throw Error(ErrorCode::damaged_chunk, file + ": chunk " + std::to_string(index) + " at offset " +
                                            std::to_string(offset) + ": found " + found +
                                            ", expected " + expected);
}

EncodedChunk encode_chunk(const Chunk& chunk, const ChunkContext& context) {
  ChunkHeader header{};
  header.tag = kChunkTag;
  header.first_node = chunk.first_node;
  header.node_count = static_cast<uint32_t>(chunk.records.size());
  header.first_child = chunk.first_child;
  header.quality = static_cast<uint32_t>(context.quality);
  header.sh_degree = static_cast<uint32_t>(context.sh_degree);
  EncodedChunk out;
  out.bytes.resize(sizeof header);
  if (context.quality == Quality::compact)
    out.position_error = encode_compact(chunk, context, header, out.bytes);
  else
    encode_lossless(chunk, out.bytes);
  header.payload_bytes = static_cast<uint32_t>(out.bytes.size() - sizeof header);
  std::memcpy(out.bytes.data(), &header, sizeof header);
  out.bytes.resize(align_to_chunk(out.bytes.size()));
  out.checksum = checksum(out.bytes);
  return out;
}

Chunk decode_chunk(std::span<const std::byte> bytes, uint64_t expected_checksum,
                   const ChunkPlace& place, const ChunkContext& context) {
  check_field(place, "checksum", checksum(bytes), expected_checksum);
  const ChunkHeader header = checked_header(bytes, place, context);
  const std::span<const std::byte> payload = bytes.subspan(sizeof header, header.payload_bytes);
  Chunk chunk;
  chunk.first_node = header.first_node;
  chunk.first_child = header.first_child;
  if (context.quality == Quality::compact)
    decode_compact(payload, header, place, context, chunk);
  else
    decode_lossless(payload, place.node_count, context, chunk);
  check_chunk(chunk, place, context);
  return chunk;
}

}  // namespace voyager
