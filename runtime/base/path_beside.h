#pragma once
#include <string>
#include <string_view>

namespace voyager {

// Is it a relative path that leads down only: no root, no "..", no backslash?
bool stays_in_folder(std::string_view path);

// The path of `reference`, which the file at `file` names: in that file's folder or below, also
// once links are resolved. Throws Error(refused_input) naming both for any other, among them
// absolute paths and those with "..".
std::string path_beside(const std::string& file, const std::string& reference);

}  // namespace voyager
