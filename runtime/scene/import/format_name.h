#pragma once
#include <string>

#include "runtime/base/file.h"

namespace voyager {

// What a flat scene's format is called, for people, with the version that a .spz says: "SPZ 3".
// Throws Error(refused_input) as its reader does; reads the header alone, but for a .spz with
// extensions at its end.
std::string format_name(const ByteSource& source);

}  // namespace voyager
