#pragma once
#include <memory>
#include <string>

#include "runtime/base/file.h"

namespace voyager {

// The file of a scene that is a folder: its lod-meta.json, meta.json or tileset.json, the first of
// these that is there. Any other path as it is.
std::string scene_file(const std::string& path);

// The file, or that of the folder, or what the http:// or https:// URL names, of which the first
// bytes are read: so it may block for as long as a read. Thread-safe. Throws as open_file_source
// does; Error(unsupported) for a URL where libvoyager_http.so is missing; and, for a URL, what
// ByteSource::read throws, Error(file_not_found) where the server has no such file.
std::unique_ptr<ByteSource> open_source(const std::string& path);

}  // namespace voyager
