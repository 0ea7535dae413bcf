#pragma once
// What the tiles of a tileset, and of those that it refers to, hold.
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/math/affine.h"
#include "runtime/scene/import/json_value.h"

namespace voyager::tileset {

// A glTF file, by what tells where it is: a path from the first tileset's folder, or a data URI.
struct Content {
  std::string place;  // as messages name it
  std::string uri;
  bool is_data = false;
  Affine transform;  // from the tile to the first tileset, z up
};

std::shared_ptr<const ByteSource> open_content(const ByteSource& first, const Content& content);

// In the order of the tiles. Throws as open() does (tileset.h).
std::vector<Content> list_contents(const ByteSource& first, nlohmann::json json);

}  // namespace voyager::tileset
