#pragma once
// What a URI in a file names: bytes inside the URI, or a file beside.
#include <memory>
#include <string>

#include "runtime/base/file.h"

namespace voyager {

// Of "data:...;base64,..." the decoded bytes; of a relative path what the source opens beside
// itself, after %20 and the like were decoded. Throws Error(refused_input) naming source and
// `place` for a damaged or another kind of URI, and what ByteSource::open_beside() throws.
std::shared_ptr<const ByteSource> open_uri(const ByteSource& source, const std::string& place,
                                           const std::string& uri);

bool is_data_uri(const std::string& uri);
// The relative path that any other URI is. Throws as above.
std::string path_of_uri(const std::string& file, const std::string& place, const std::string& uri);

}  // namespace voyager
