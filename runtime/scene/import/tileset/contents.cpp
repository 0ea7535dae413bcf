#include "runtime/scene/import/tileset/contents.h"

#include <algorithm>
#include <array>
#include <deque>
#include <filesystem>

#include "runtime/scene/import/gltf/file.h"
#include "runtime/scene/import/gltf/nodes.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/import/tileset/tileset.h"
#include "runtime/scene/import/uri.h"

namespace voyager::tileset {
namespace {

// The children of a tile that are still to be visited: a tile at a time, so that memory follows the
// depth and not the number of tiles.
struct Children {
  JsonValue json;  // an array
  size_t next, count;
  Affine parent;
  bool added;  // as the parent says: children are drawn beside their parent, not in its place
};

// One file of tiles. Its JSON is read when its turn comes: many may wait, in little text.
struct Tiles {
  Content content;           // of none the first
  std::string name, folder;  // the folder from the first one's
  int depth;
};

enum class Kind { glb, gltf, tileset, other };

Kind kind_of(const ByteSource& source) {
  if (gltf::is_binary(source)) return Kind::glb;
  std::array<std::byte, 1> first{};
  if (source.size() > 0) source.read(0, first);
  const auto c = std::to_integer<char>(first[0]);
  if (c != '{' && c != ' ' && c != '\t' && c != '\r' && c != '\n') return Kind::other;
  return is_tileset(gltf::read_json(source)) ? Kind::tileset : Kind::gltf;
}

std::string first_letters(const ByteSource& source) {
  std::array<std::byte, 4> first{};
  const auto some = std::span(first).first(std::min<uint64_t>(first.size(), source.size()));
  source.read(0, some);
  std::string text;
  for (const std::byte b : some) {
    const int c = std::to_integer<int>(b);
    text += c >= 32 && c < 127 ? static_cast<char>(c) : '?';
  }
  return text;
}

class Walk {
 public:
  explicit Walk(const ByteSource& first) : first_(first) {}

  std::vector<Content> run(nlohmann::json json) {
    seen_.insert(std::filesystem::path(first_.name()).filename().string());
    visit_file(json, {{}, first_.name(), "", 0});
    json = {};
    while (!files_.empty()) {
      const Tiles file = std::move(files_.front());
      files_.pop_front();
      visit_file(gltf::read_json(*open_content(first_, file.content)), file);
    }
    return std::move(contents_);
  }

 private:
  void visit_file(const nlohmann::json& text, const Tiles& file) {
    const JsonValue json(file.name, 0, text);
    require_readable(json);
    std::vector<Children> open;
    visit(json["root"], file, file.content.transform, false, open);
    while (!open.empty()) {
      Children& siblings = open.back();
      if (siblings.next == siblings.count) {
        open.pop_back();
        continue;
      }
      const JsonValue tile = siblings.json[siblings.next++];
      const Affine parent = siblings.parent;
      const bool added = siblings.added;
      visit(tile, file, parent, added, open);
    }
  }

  static void require_readable(const JsonValue& json) {
    const JsonValue asset = json["asset"];
    const std::string& version = asset["version"].text();
    if (version != "1.0" && version != "1.1") asset["version"].refuse("\"1.0\" or \"1.1\"");
    if (asset.has("gltfUpAxis") && asset["gltfUpAxis"].text() != "Y")
      asset["gltfUpAxis"].refuse("\"Y\"");
    if (!json.has("extensionsRequired")) return;
    const JsonValue required = json["extensionsRequired"];
    for (size_t i = 0; i < required.size(); ++i)
      if (required[i].text() != "3DTILES_content_gltf")
        required[i].refuse("3DTILES_content_gltf: no other extension is read");
  }

  void visit(const JsonValue& json, const Tiles& file, const Affine& parent, bool added,
             std::vector<Children>& open) {
    if (json.has("implicitTiling"))
      json["implicitTiling"].refuse("implicit tiles", "explicit ones: no others are read");
    const Affine transform =
        json.has("transform") ? parent * gltf::matrix_of(json["transform"]) : parent;
    const bool adds = json.has("refine") ? refines_by_adding(json["refine"]) : added;
    const size_t children = json.has("children") ? json["children"].size() : 0;
    if (children == 0 || adds) add_contents(json, file, transform);
    if (children > 0) open.push_back({json["children"], 0, children, transform, adds});
  }

  static bool refines_by_adding(const JsonValue& refine) {
    if (refine.text() == "ADD" || refine.text() == "add") return true;
    if (refine.text() != "REPLACE" && refine.text() != "replace") refine.refuse("ADD or REPLACE");
    return false;
  }

  void add_contents(const JsonValue& tile, const Tiles& file, const Affine& transform) {
    if (tile.has("content")) add(tile["content"], file, transform);
    if (!tile.has("contents")) return;
    const JsonValue contents = tile["contents"];
    for (size_t i = 0; i < contents.size(); ++i) add(contents[i], file, transform);
  }

  void add(const JsonValue& json, const Tiles& file, const Affine& transform) {
    const JsonValue uri = json.has("url") && !json.has("uri") ? json["url"] : json["uri"];
    Content content{file.name + ": " + uri.place(), uri.text(), is_data_uri(uri.text()), transform};
    if (!content.is_data)
      content.uri =
          (std::filesystem::path(file.folder) / path_of_uri(file.name, uri.place(), uri.text()))
              .lexically_normal()
              .string();
    if (scenes_.count(content.uri) != 0) {
      contents_.push_back(std::move(content));
      return;
    }
    const auto source = open_content(first_, content);
    switch (kind_of(*source)) {
      case Kind::glb:
      case Kind::gltf:
        scenes_.insert(content.uri);
        contents_.push_back(std::move(content));
        return;
      case Kind::tileset:
        return add_file(uri, std::move(content), source->name(), file.depth + 1);
      case Kind::other:
        uri.refuse("a file that begins with " + first_letters(*source),
                   "a .glb, a .gltf or a tileset.json: no other content is read");
    }
  }

  void add_file(const JsonValue& uri, Content content, const std::string& name, int depth) {
    if (!content.is_data && !seen_.insert(content.uri).second)
      uri.refuse(content.uri + " once more", "each tileset in one place");
    if (depth > kMostDepth)
      uri.refuse("more than " + std::to_string(kMostDepth) + " tilesets in one another", "fewer");
    std::string folder =
        content.is_data ? "" : std::filesystem::path(content.uri).parent_path().string();
    files_.push_back({std::move(content), name, std::move(folder), depth});
  }

  const ByteSource& first_;
  std::deque<Tiles> files_;
  std::set<std::string> seen_;    // tilesets, by their paths from the first one's folder
  std::set<std::string> scenes_;  // glTF files, by their URIs: read once to tell what they are
  std::vector<Content> contents_;
};

}  // namespace

std::shared_ptr<const ByteSource> open_content(const ByteSource& first, const Content& content) {
  if (content.is_data) return open_uri(first, content.place, content.uri);
  return first.open_beside(content.uri);
}

std::vector<Content> list_contents(const ByteSource& first, nlohmann::json json) {
  return Walk(first).run(std::move(json));
}

}  // namespace voyager::tileset
