#include "runtime/scene/import/rad/header.h"

#include <cstring>
#include <string_view>

#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/json_value.h"
#include "runtime/scene/import/load.h"
#include "runtime/scene/import/refuse.h"

namespace voyager::rad {
namespace {

constexpr uint64_t kBeforeJson = 8;  // mark and length
constexpr int kJsonLevels = 8;       // in one another; Spark's take 3
constexpr uint64_t kMostWhole = uint64_t{1} << 53;

constexpr uint64_t rounded_to_8(uint64_t bytes) {
  return (bytes + 7) / 8 * 8;
}

Header header_of(const JsonValue& json) {
  json["version"].whole(1, 1);
  if (json["type"].text() != "gsplat") json["type"].refuse("\"gsplat\"");
  Header header;
  header.count = json["count"].whole(kMostWhole, 1);
  header.sh_degree = static_cast<int>(json.whole_or("maxSh", 0, 3));
  header.is_tree = json.has("lodTree") && json["lodTree"].flag();
  return header;
}

uint64_t chunk_size_of(const JsonValue& json, uint64_t count) {
  if (json.has("chunkSize")) return json["chunkSize"].whole(kMostChunkGaussians, 1);
  if (count > kMostChunkGaussians)
    json["count"].refuse("at most " + std::to_string(kMostChunkGaussians) + " in one chunk");
  return count;
}

// `end` is where the chunks before it in the file end, and after this where it does.
ChunkPlace place_of(const JsonValue& range, uint64_t begin, uint64_t file_bytes, uint64_t& end) {
  ChunkPlace place;
  place.offset = range["offset"].whole(kMostWhole);
  place.bytes = range["bytes"].whole(kMostWhole);
  if (range.has("filename")) {
    place.file = range["filename"].text();
    if (place.file.empty()) range["filename"].refuse("the name of a file");
    return place;
  }
  place.offset += begin;
  if (place.offset < end || place.offset > file_bytes || place.bytes > file_bytes - place.offset)
    range.refuse(std::to_string(place.bytes) + " bytes from byte " + std::to_string(place.offset),
                 "a place from byte " + std::to_string(end) + " on in the file's " +
                     std::to_string(file_bytes));
  end = place.offset + place.bytes;
  return place;
}

std::vector<ChunkPlace> places_of(const JsonValue& json, const Header& header, uint64_t begin,
                                  uint64_t file_bytes) {
  const uint64_t size = chunk_size_of(json, header.count);
  const JsonValue ranges = json["chunks"];
  const uint64_t expected = (header.count - 1) / size + 1;
  if (ranges.size() != expected)
    ranges.refuse(std::to_string(ranges.size()) + " chunks",
                  std::to_string(expected) + " of " + std::to_string(size) + " Gaussians each");
  std::vector<ChunkPlace> places;
  uint64_t end = begin, bytes = 0;
  for (size_t i = 0; i < ranges.size(); ++i) {
    ChunkPlace place = place_of(ranges[i], begin, file_bytes, end);
    place.base = i * size;
    place.count = std::min(size, header.count - place.base);
    for (const auto& [name, value] : {std::pair{"base", place.base}, {"count", place.count}})
      if (ranges[i].has(name)) ranges[i][name].whole(value, value);
    bytes = std::min(bytes + place.bytes, kMostWhole);
    places.push_back(std::move(place));
  }
  const uint64_t most = most_gaussians(bytes, bytes_of_gaussian(header.sh_degree));
  if (header.count > most)
    json["count"].refuse("at most " + std::to_string(most) + " in chunks of " +
                         std::to_string(bytes) + " bytes");
  return places;
}

}  // namespace

Opening read_opening(const ByteSource& source, uint64_t offset, uint64_t bytes, const char* mark,
                     uint64_t most_json, const std::string& what) {
  std::byte head[kBeforeJson];
  if (bytes < sizeof head)
    refuse(source.name(), offset, what, std::to_string(bytes) + " bytes", "at least 8");
  source.read(offset, head);
  if (std::memcmp(head, mark, 4) != 0)
    refuse(source.name(), offset, what, "other first bytes", std::string("the mark ") + mark);
  const uint64_t length = load<uint32_t>(head + 4);
  const uint64_t end = kBeforeJson + rounded_to_8(length);
  if (end > bytes || length > most_json)
    refuse(source.name(), offset + 4, "length of the JSON of the " + what, std::to_string(length),
           "at most " + std::to_string(std::min(bytes - kBeforeJson, most_json)));
  std::vector<std::byte> text(static_cast<size_t>(length));
  source.read(offset + kBeforeJson, text);
  const std::string_view view(reinterpret_cast<const char*>(text.data()), text.size());
  return {parse_json(source.name(), offset + kBeforeJson, view, kJsonLevels), offset + kBeforeJson,
          offset + end};
}

File read_header(const ByteSource& source) {
  const Opening opening =
      read_opening(source, 0, source.size(), "RAD0", kMostJsonBytes, "header of the .rad");
  const JsonValue json(source.name(), opening.json_offset, opening.json);
  File file;
  file.header = header_of(json);
  file.chunks = places_of(json, file.header, opening.end, source.size());
  return file;
}

}  // namespace voyager::rad
