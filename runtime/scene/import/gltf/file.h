#pragma once
// A .glb or .gltf: its JSON, and the buffers that the JSON describes.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/scene/import/json_value.h"

namespace voyager::gltf {

inline constexpr uint64_t kMostIndex = UINT32_MAX;

// Bytes where they lie: within `source`, checked.
struct Slice {
  std::shared_ptr<const ByteSource> source;
  uint64_t offset = 0, size = 0;
};

// As a file of its own.
std::shared_ptr<const ByteSource> source_of(const Slice& slice, std::string name);

// Does the file begin as a .glb does? A .gltf begins with JSON.
bool is_binary(const ByteSource& source);

// The JSON of a file that is JSON alone, at most kMostJsonBytes of it.
nlohmann::json read_json(const ByteSource& source);

// Of a map as File::bytes().
uint64_t sum_of(const std::map<std::string, uint64_t>& bytes);

class File {
 public:
  // Reads header and JSON. Throws Error(refused_input) naming place, found and expected.
  explicit File(std::shared_ptr<const ByteSource> source);
  // Of a .gltf whose JSON was read.
  File(std::shared_ptr<const ByteSource> source, nlohmann::json json);

  const std::string& name() const { return source_->name(); }
  JsonValue json() const { return JsonValue(source_->name(), json_offset_, json_); }
  // Opens the view's buffer when it is asked for first. `index`: a JSON number.
  Slice view(const JsonValue& index);
  // Of the file and of all buffers that were opened beside it, by their paths: as many as
  // it uses of each, which counts once however many buffers it is.
  const std::map<std::string, uint64_t>& bytes() const { return bytes_; }

 private:
  void read_chunks();
  Slice buffer(const JsonValue& index);
  Slice open_buffer(const JsonValue& description, uint64_t index);
  std::shared_ptr<const ByteSource> open_once(const JsonValue& uri);

  std::shared_ptr<const ByteSource> source_;
  nlohmann::json json_;
  uint64_t json_offset_ = 0;
  std::map<std::string, uint64_t> bytes_;
  std::map<std::string, std::shared_ptr<const ByteSource>> beside_;  // open files, by their URIs
  Slice binary_;  // of a .glb; else without a source
  std::vector<Slice> buffers_;
};

}  // namespace voyager::gltf
