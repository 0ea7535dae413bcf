#include "runtime/scene/import/gltf/file.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "runtime/scene/gltf_format.h"
#include "runtime/scene/import/load.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/import/uri.h"

namespace voyager::gltf {
namespace {

struct Chunk {
  uint32_t type;
  uint64_t offset, size;
};

Chunk chunk_at(const ByteSource& source, uint64_t offset) {
  std::array<std::byte, kChunkHeaderBytes> head;
  if (source.size() - offset < head.size())
    refuse(source.name(), offset, "chunk header", std::to_string(source.size() - offset) + " bytes",
           std::to_string(head.size()));
  source.read(offset, head);
  const Chunk chunk{load<uint32_t>(&head[4]), offset + head.size(), load<uint32_t>(&head[0])};
  if (chunk.size > source.size() - chunk.offset)
    refuse(source.name(), offset, "chunk length", std::to_string(chunk.size),
           "at most " + std::to_string(source.size() - chunk.offset) + ", to the end of the file");
  return chunk;
}

// A range of a file as a file of its own.
class SliceSource final : public ByteSource {
 public:
  SliceSource(Slice slice, std::string name) : slice_(std::move(slice)), name_(std::move(name)) {}
  const std::string& name() const override { return name_; }
  uint64_t size() const override { return slice_.size; }
  void read(uint64_t offset, std::span<std::byte> into) const override {
    check_range(*this, offset, into.size());
    slice_.source->read(slice_.offset + offset, into);
  }

 private:
  Slice slice_;
  std::string name_;
};

nlohmann::json json_of(const ByteSource& source, uint64_t offset, uint64_t size) {
  if (size > kMostJsonBytes)
    refuse(source.name(), offset, "JSON", std::to_string(size) + " bytes",
           "at most " + std::to_string(kMostJsonBytes));
  std::string text(static_cast<size_t>(size), '\0');
  source.read(offset, std::as_writable_bytes(std::span(text)));
  return parse_json(source.name(), offset, text);
}

// As File::bytes() knows a source.
std::string path_of(const ByteSource& source) {
  return std::filesystem::path(source.name()).lexically_normal().string();
}

}  // namespace

uint64_t sum_of(const std::map<std::string, uint64_t>& bytes) {
  uint64_t sum = 0;
  for (const auto& [path, size] : bytes) sum += size;
  return sum;
}

std::shared_ptr<const ByteSource> source_of(const Slice& slice, std::string name) {
  return std::make_shared<SliceSource>(slice, std::move(name));
}

bool is_binary(const ByteSource& source) {
  std::array<std::byte, 4> magic;
  if (source.size() < magic.size()) return false;
  source.read(0, magic);
  return load<uint32_t>(magic.data()) == kMagic;
}

nlohmann::json read_json(const ByteSource& source) {
  return json_of(source, 0, source.size());
}

File::File(std::shared_ptr<const ByteSource> source) : source_(std::move(source)) {
  bytes_[path_of(*source_)] = source_->size();
  if (is_binary(*source_))
    read_chunks();
  else
    json_ = read_json(*source_);
  if (json().has("buffers")) buffers_.resize(json()["buffers"].size());
}

File::File(std::shared_ptr<const ByteSource> source, nlohmann::json json)
    : source_(std::move(source)), json_(std::move(json)) {
  bytes_[path_of(*source_)] = source_->size();
  if (this->json().has("buffers")) buffers_.resize(this->json()["buffers"].size());
}

void File::read_chunks() {
  std::array<std::byte, kHeaderBytes> head;
  if (source_->size() < head.size())
    refuse(name(), 0, "header", std::to_string(source_->size()) + " bytes",
           std::to_string(head.size()));
  source_->read(0, head);
  if (load<uint32_t>(&head[4]) != kVersion)
    refuse(name(), 4, "version", std::to_string(load<uint32_t>(&head[4])),
           std::to_string(kVersion));
  if (load<uint32_t>(&head[8]) != source_->size())
    refuse(name(), 8, "length", std::to_string(load<uint32_t>(&head[8])),
           std::to_string(source_->size()) + ", the bytes of the file");
  const Chunk text = chunk_at(*source_, kHeaderBytes);
  if (text.type != kJsonChunk)
    refuse(name(), kHeaderBytes + 4, "type of the first chunk", std::to_string(text.type),
           std::to_string(kJsonChunk) + " (JSON)");
  json_offset_ = text.offset;
  json_ = json_of(*source_, text.offset, text.size);
  // Chunks of other types may follow, and are not for us.
  for (uint64_t at = text.offset + text.size; at < source_->size();) {
    const Chunk chunk = chunk_at(*source_, at);
    if (chunk.type == kBinaryChunk && !binary_.source)
      binary_ = {source_, chunk.offset, chunk.size};
    at = chunk.offset + chunk.size;
  }
}

Slice File::view(const JsonValue& index) {
  const JsonValue description = json()["bufferViews"][index.whole(kMostIndex)];
  const Slice all = buffer(description["buffer"]);
  const uint64_t offset = description.whole_or("byteOffset", 0, UINT64_MAX);
  const uint64_t size = description["byteLength"].whole(UINT64_MAX);
  if (offset > all.size || size > all.size - offset)
    description.refuse(std::to_string(size) + " bytes from " + std::to_string(offset),
                       "a range of the buffer's " + std::to_string(all.size));
  return {all.source, all.offset + offset, size};
}

Slice File::buffer(const JsonValue& index) {
  const uint64_t number = index.whole(kMostIndex);
  const JsonValue description = json()["buffers"][number];
  Slice& known = buffers_[number];
  if (!known.source) known = open_buffer(description, number);
  return known;
}

// Many buffers may be one file, which takes one descriptor.
std::shared_ptr<const ByteSource> File::open_once(const JsonValue& uri) {
  if (is_data_uri(uri.text())) return open_uri(*source_, uri.place(), uri.text());
  std::shared_ptr<const ByteSource>& known = beside_[uri.text()];
  if (!known) known = open_uri(*source_, uri.place(), uri.text());
  return known;
}

Slice File::open_buffer(const JsonValue& description, uint64_t index) {
  const JsonValue length = description["byteLength"];
  Slice all;
  if (description.has("uri")) {
    const JsonValue uri = description["uri"];
    all.source = open_once(uri);
    all.size = all.source->size();
    // What is in a URI is bytes of the file itself.
    if (!is_data_uri(uri.text())) {
      uint64_t& used = bytes_[path_of(*all.source)];
      used = std::max(used, std::min(all.size, length.whole(UINT64_MAX)));
    }
  } else if (index == 0 && binary_.source) {
    all = binary_;
  } else {
    description.refuse("no uri", "one, or the first buffer of a .glb with a BIN chunk");
  }
  all.size = std::min(all.size, length.whole(UINT64_MAX));
  if (all.size != length.whole(UINT64_MAX))
    length.refuse("at most " + std::to_string(all.size) + ", the bytes that are there");
  return all;
}

}  // namespace voyager::gltf
