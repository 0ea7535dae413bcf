#include "runtime/scene/import/sog/lod_meta.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <unordered_set>

#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/json_value.h"
#include "runtime/scene/import/refuse.h"

namespace voyager::sog {
namespace {

constexpr int kLodLevels = 128;  // of JSON: a level of the tree takes two
constexpr uint64_t kMostGaussians = uint64_t{1} << 40;

struct Range {
  uint64_t file, first, count;
};

class Tree {
 public:
  Tree(const JsonValue& root, uint64_t files) : files_(files) { visit(root); }
  const std::vector<Range>& ranges() const { return ranges_; }

 private:
  void visit(const JsonValue& node) {
    if (node.has("children")) {
      const JsonValue children = node["children"];
      for (size_t i = 0; i < children.size(); ++i) visit(children[i]);
    }
    if (node.has("lods")) take_finest(node["lods"]);
  }

  // Level 0 is the finest. A leaf may lack it.
  void take_finest(const JsonValue& levels) {
    if (!levels.json().is_object()) levels.refuse("an object of levels");
    const std::string* finest = nullptr;
    uint64_t least = UINT64_MAX;
    for (const auto& entry : levels.json().items()) {
      uint64_t level = 0;
      const std::string& key = entry.key();
      const auto [end, problem] = std::from_chars(key.data(), key.data() + key.size(), level);
      if (problem != std::errc() || end != key.data() + key.size())
        levels.refuse("levels whose names are numbers");
      if (level < least) finest = &entry.key(), least = level;
    }
    if (!finest) return;
    const JsonValue level = levels[*finest];
    ranges_.push_back({level["file"].whole(files_ - 1), level["offset"].whole(kMostGaussians),
                       level["count"].whole(kMostGaussians)});
  }

  uint64_t files_;
  std::vector<Range> ranges_;
};

nlohmann::json read(const ByteSource& source) {
  const std::vector<std::byte> bytes = read_all(source);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return parse_json(source.name(), 0, text, kLodLevels);
}

std::string plain_path(const std::string& path) {
  return std::filesystem::path(path).lexically_normal().string();
}

std::vector<std::string> file_names(const JsonValue& names) {
  std::vector<std::string> files;
  std::unordered_set<std::string> seen;
  for (size_t i = 0; i < names.size(); ++i) {
    const JsonValue name = names[i];
    files.push_back(name.text());
    if (!seen.insert(plain_path(files.back())).second) name.refuse("each file once");
  }
  if (files.empty()) names.refuse("at least one file");
  return files;
}

std::string environment(const JsonValue& name, const std::vector<std::string>& files) {
  const std::string path = plain_path(name.text());
  for (const std::string& file : files)
    if (plain_path(file) == path) name.refuse("a file that is not one of filenames");
  return name.text();
}

// Joins those that follow one another; refuses those that share a Gaussian.
std::vector<Part> joined(const std::string& name, std::vector<Range> ranges,
                         const std::vector<std::string>& files) {
  std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) {
    return std::pair(a.file, a.first) < std::pair(b.file, b.first);
  });
  std::vector<Part> parts;
  uint64_t last_file = UINT64_MAX;
  for (const Range& range : ranges) {
    if (range.count == 0) continue;
    const bool same = range.file == last_file;
    const uint64_t end = same ? parts.back().first + parts.back().count : 0;
    if (same && range.first < end)
      refuse(name, 0, "tree",
             "Gaussian " + std::to_string(range.first) + " of " + files[range.file] + " twice",
             "each once");
    if (same && range.first == end)
      parts.back().count += range.count;
    else
      parts.push_back({files[range.file], range.first, range.count});
    last_file = range.file;
  }
  return parts;
}

}  // namespace

std::vector<Part> finest_level(const ByteSource& lod_meta) {
  const nlohmann::json parsed = read(lod_meta);
  const JsonValue json(lod_meta.name(), 0, parsed);
  const std::vector<std::string> files = file_names(json["filenames"]);
  std::vector<Part> parts =
      joined(lod_meta.name(), Tree(json["tree"], files.size()).ranges(), files);
  if (json.has("environment"))
    parts.push_back({environment(json["environment"], files), 0, UINT64_MAX});
  return parts;
}

}  // namespace voyager::sog
