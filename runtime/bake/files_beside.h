#pragma once
#include <set>
#include <string>

namespace voyager {

// The files that an input refers to, in their order by name: buffers of a glTF, tiles of a tileset,
// images of a SOG folder, and what those refer to. Reads headers. Throws as open_blocks() does.
std::set<std::string> files_beside(const std::string& input);

}  // namespace voyager
