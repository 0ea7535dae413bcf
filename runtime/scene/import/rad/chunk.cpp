#include "runtime/scene/import/rad/chunk.h"

#include <zlib.h>

#include <algorithm>
#include <new>

#include "runtime/scene/import/load.h"
#include "runtime/scene/import/refuse.h"

namespace voyager::rad {
namespace {

constexpr uint64_t kMostJson = 1 << 20;       // Spark's have some 2,000 bytes
constexpr uint64_t kMostDeflateRatio = 1032;  // of which deflate is capable
constexpr uint64_t kPayloadLength = 8;

[[noreturn]] void refuse_property(const Chunk& chunk, const Property& property,
                                  const std::string& found, const std::string& expected) {
  refuse(chunk.source->name(), chunk.payload + property.offset, "bytes of a property", found,
         expected);
}

void check_size(const Chunk& chunk, const Property& property, uint64_t plain) {
  const uint64_t bytes = property.bytes;
  const bool fits = property.is_deflated
                        ? bytes <= 2 * plain + 64 && plain <= kMostDeflateRatio * (bytes + 1)
                        : bytes == plain;
  if (!fits)
    refuse_property(
        chunk, property, std::to_string(bytes) + " bytes",
        (property.is_deflated ? "what decompresses to " : "") + std::to_string(plain) + " bytes");
}

// True if the raw deflate stream `from` has as many bytes as `to`, no more and no fewer.
bool inflate_all(std::vector<std::byte>& from, std::span<std::byte> to) {
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
  stream.next_in = reinterpret_cast<Bytef*>(from.data());
  stream.avail_in = static_cast<uInt>(from.size());
  stream.next_out = reinterpret_cast<Bytef*>(to.data());
  stream.avail_out = static_cast<uInt>(to.size());
  const int code = inflate(&stream, Z_FINISH);
  inflateEnd(&stream);
  if (code == Z_MEM_ERROR) throw std::bad_alloc();
  return code == Z_STREAM_END && stream.avail_in == 0 && stream.avail_out == 0;
}

void add_up(std::vector<std::byte>& plain, const Property& property, size_t count) {
  if (property.encoding != Encoding::r8_delta && property.encoding != Encoding::s8_delta) return;
  for (size_t begin = 0; begin < plain.size(); begin += count)
    for (size_t i = begin + 1; i < begin + count; ++i)
      plain[i] = static_cast<std::byte>(integer(plain[i]) + integer(plain[i - 1]));
}

}  // namespace

Chunk open_chunk(const std::shared_ptr<const ByteSource>& rad, const Header& header,
                 const ChunkPlace& place) {
  Chunk chunk;
  chunk.source = place.file.empty() ? rad : rad->open_beside(place.file);
  chunk.count = place.count;
  const ByteSource& source = *chunk.source;
  if (place.offset > source.size() || place.bytes > source.size() - place.offset)
    refuse(source.name(), place.offset, "chunk", std::to_string(source.size()) + " bytes",
           std::to_string(place.bytes) + " from there on, as " + rad->name() + " says");
  const Opening opening =
      read_opening(source, place.offset, place.bytes, "RADC", kMostJson, "chunk");
  const JsonValue json(source.name(), opening.json_offset, opening.json);
  json["version"].whole(1, 1);
  json["base"].whole(place.base, place.base);
  json["count"].whole(place.count, place.count);
  const uint64_t left = place.offset + place.bytes - opening.end;
  std::byte length[kPayloadLength];
  if (left < sizeof length)
    refuse(source.name(), opening.end, "length of the payload", std::to_string(left) + " bytes",
           "8");
  source.read(opening.end, length);
  const auto payload = load<uint64_t>(length);
  if (payload > left - sizeof length)
    refuse(source.name(), opening.end, "length of the payload", std::to_string(payload),
           "at most " + std::to_string(left - sizeof length));
  chunk.payload = opening.end + sizeof length;
  chunk.properties = read_properties(json["properties"], header.sh_degree, header.is_tree, payload);
  return chunk;
}

std::vector<std::byte> read_plain(const Chunk& chunk, const Property& property) {
  const uint64_t plain_bytes = chunk.count * plain_bytes_of(property);
  check_size(chunk, property, plain_bytes);
  std::vector<std::byte> stored(static_cast<size_t>(property.bytes));
  chunk.source->read(chunk.payload + property.offset, stored);
  if (property.is_deflated) {
    std::vector<std::byte> plain(static_cast<size_t>(plain_bytes));
    if (!inflate_all(stored, plain))
      refuse_property(chunk, property, "other bytes",
                      "raw deflate of " + std::to_string(plain_bytes) + " bytes");
    stored = std::move(plain);
  }
  add_up(stored, property, static_cast<size_t>(chunk.count));
  return stored;
}

std::vector<uint32_t> leaves_of(const Chunk& chunk) {
  const auto kind = static_cast<size_t>(Kind::child_count);
  const std::vector<std::byte> counts = read_plain(chunk, *chunk.properties[kind]);
  std::vector<uint32_t> leaves;
  for (uint32_t i = 0; i < chunk.count; ++i)
    if (load<uint16_t>(&counts[2 * size_t{i}]) == 0) leaves.push_back(i);
  return leaves;
}

}  // namespace voyager::rad
