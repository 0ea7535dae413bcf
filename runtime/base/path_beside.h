#pragma once
#include <string>

namespace voyager {

// The path of `reference`, which the file at `file` names: in that file's folder or below, also
// once links are resolved. Throws Error(refused_input) naming both for any other, among them
// absolute paths and those with "..".
std::string path_beside(const std::string& file, const std::string& reference);

}  // namespace voyager
