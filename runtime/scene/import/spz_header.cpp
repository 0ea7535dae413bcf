#include "runtime/scene/import/spz_header.h"

#include <algorithm>
#include <cstdio>

#include "runtime/scene/import/decompress.h"
#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/load.h"
#include "runtime/scene/import/refuse.h"

namespace voyager::spz {
namespace {

constexpr int kMaxFractionalBits = 24;
constexpr uint64_t kMostInflation = 1032;  // bytes that deflate may make of one

template <size_t count>
std::array<std::byte, count> read_bytes(ByteReader& reader, const char* what) {
  std::array<std::byte, count> bytes;
  const size_t got = reader.read(bytes);
  if (got != count)
    refuse(reader.name(), reader.offset(), what, std::to_string(got) + " bytes",
           std::to_string(count) + " bytes");
  return bytes;
}

std::string hex(uint64_t value) {
  char text[32];
  std::snprintf(text, sizeof text, "0x%llx", static_cast<unsigned long long>(value));
  return text;
}

uint64_t in_range(const std::string& file, uint64_t offset, const char* field, uint64_t value,
                  uint64_t low, uint64_t high) {
  if (value < low || value > high)
    refuse(file, offset, field, std::to_string(value),
           low == high ? std::to_string(low) : std::to_string(low) + " to " + std::to_string(high));
  return value;
}

}  // namespace

Header read_header(ByteReader& plain, uint32_t newest_version) {
  const uint64_t at = plain.offset();
  const auto bytes = read_bytes<kHeaderBytes>(plain, "header");
  const std::string& file = plain.name();
  const auto field = [&](const char* name, size_t offset, uint64_t low, uint64_t high) {
    return static_cast<uint8_t>(
        in_range(file, at + offset, name, load<uint8_t>(&bytes[offset]), low, high));
  };
  const uint64_t magic = load<uint32_t>(&bytes[0]);
  if (magic != kMagic) refuse(file, at, "magic", hex(magic), hex(kMagic) + " (NGSP)");
  Header header;
  header.version = static_cast<uint32_t>(
      in_range(file, at + 4, "version", load<uint32_t>(&bytes[4]), 1, newest_version));
  header.count = load<uint32_t>(&bytes[8]);
  header.stored_sh_degree = field("SH degree", 12, 0, kMostStoredShDegree);
  header.sh_degree = std::min(header.stored_sh_degree, kMaxShDegree);
  header.fractional_bits = field("fractional bits", 13, 0, kMaxFractionalBits);
  const uint8_t flags = field("flags", 14, 0, kFlagAntialiased | kFlagExtensions);
  header.antialiased = (flags & kFlagAntialiased) != 0;
  header.has_extensions = (flags & kFlagExtensions) != 0;
  header.last =
      header.version < 4 ? field("reserved byte", 15, 0, 0) : field("streams", 15, 0, 255);
  return header;
}

void check_count(const PeekReader& input, const Header& header, bool gzipped) {
  const std::optional<uint64_t> left = input.remaining();
  if (!left) return;
  const uint64_t length = input.offset() + *left;
  uint64_t most = most_gaussians(length, bytes_of_gaussian(header.sh_degree));
  if (gzipped) {
    uint64_t stored = 0;  // bytes of a Gaussian
    for (int i = 0; i < header.attributes(); ++i)
      stored += header.bytes_of(static_cast<Attribute>(i));
    most = std::min(most, length * kMostInflation / stored);
  }
  if (header.count > most)
    refuse(
        input.name(), input.offset(), "Gaussians", std::to_string(header.count),
        "at most " + std::to_string(most) + " in a file of " + std::to_string(length) + " bytes");
}

StreamTable read_stream_table(PeekReader& input, const Header& header) {
  const std::string& file = input.name();
  const uint64_t at = input.offset(), start = at - kHeaderBytes;
  const uint64_t streams = static_cast<uint64_t>(header.attributes());
  in_range(file, at - 1, "streams", header.last, streams, streams);
  const auto rest = read_bytes<kStreamsHeaderBytes - kHeaderBytes>(input, "header");
  const uint64_t table = load<uint32_t>(&rest[0]);
  const uint64_t furthest = kStreamsHeaderBytes + (header.has_extensions ? kMostExtensionBytes : 0);
  in_range(file, at, "offset of the stream table", table, kStreamsHeaderBytes, furthest);
  for (size_t i = 4; i < rest.size(); ++i)
    in_range(file, at + i, "reserved byte", load<uint8_t>(&rest[i]), 0, 0);
  StreamTable found;
  const uint64_t gap = table - kStreamsHeaderBytes, gap_at = input.offset();
  std::vector<std::byte> records(gap);
  const uint64_t got = input.read(records);
  in_range(file, input.offset(), "bytes before the stream table", got, gap, gap);
  found.extensions = read_extensions(file, gap_at, records);

  uint64_t expected_end = start + table + streams * kTableEntryBytes;
  for (size_t i = 0; i < streams; ++i) {
    const uint64_t entry_at = input.offset();
    const auto entry = read_bytes<kTableEntryBytes>(input, "stream table");
    const std::string name = kAttributeName[i];
    const uint64_t size = header.count * uint64_t{header.bytes_of(static_cast<Attribute>(i))};
    in_range(file, entry_at + 8, (name + ": uncompressed size").c_str(), load<uint64_t>(&entry[8]),
             size, size);
    const uint64_t compressed = found.compressed[i] = load<uint64_t>(&entry[0]);
    if (__builtin_add_overflow(expected_end, compressed, &expected_end))
      refuse(file, entry_at, name + ": compressed size", std::to_string(compressed), "less");
  }
  if (const auto left = input.remaining(); left && input.offset() + *left != expected_end)
    refuse(file, input.offset(), "streams", std::to_string(*left) + " bytes",
           std::to_string(expected_end - input.offset()) + " bytes, as the stream table says");
  return found;
}

Extensions read_last_extensions(ByteReader& plain, const Header& header) {
  if (!header.has_extensions) return {};
  const uint64_t at = plain.offset();
  const std::vector<std::byte> records = read_as_they_come(plain, kMostExtensionBytes + 1);
  if (records.size() > kMostExtensionBytes)
    refuse(plain.name(), at, "extensions",
           "more than " + std::to_string(kMostExtensionBytes) + " bytes after the last attribute",
           "fewer, and then the end of the file");
  return read_extensions(plain.name(), at, records);
}

Announcement read_announcement(const ByteSource& source) {
  const std::unique_ptr<ByteReader> reader = read_source(source);
  PeekReader input(*reader);
  Announcement found;
  std::unique_ptr<GzipReader> gzip;
  const std::span<const std::byte> first = input.peek(1);
  if (!first.empty() && first[0] == std::byte{0x1f}) gzip = std::make_unique<GzipReader>(input);
  ByteReader& plain = gzip ? static_cast<ByteReader&>(*gzip) : input;
  found.header = read_header(plain, gzip ? kNewestPlanar : kNewest);
  check_count(input, found.header, gzip != nullptr);
  if (!found.header.has_extensions) return found;
  if (found.header.version == kNewest) {
    found.extensions = read_stream_table(input, found.header).extensions;
    return found;
  }
  PeekReader stepper(plain);
  for (int i = 0; i < found.header.attributes(); ++i)
    stepper.skip(uint64_t{found.header.count} * found.header.bytes_of(static_cast<Attribute>(i)));
  found.extensions = read_last_extensions(stepper, found.header);
  return found;
}

}  // namespace voyager::spz
