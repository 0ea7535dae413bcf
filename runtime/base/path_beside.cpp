#include "runtime/base/path_beside.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "runtime/base/error.h"

namespace voyager {
namespace {

using Path = std::filesystem::path;

bool stays_below(const std::string& reference) {
  if (reference.empty() || reference.find('\0') != std::string::npos) return false;
  const Path path(reference);
  return path.is_relative() &&
         std::none_of(path.begin(), path.end(), [](const Path& part) { return part == ".."; });
}

}  // namespace

std::string path_beside(const std::string& file, const std::string& reference) {
  const Path folder = Path(file).parent_path();
  const Path path = (folder.empty() ? Path(".") : folder) / reference;
  bool inside = stays_below(reference);
  if (inside) {
    std::error_code failed;
    const Path real_folder =
        std::filesystem::weakly_canonical(folder.empty() ? "." : folder, failed);
    const Path real_path = std::filesystem::weakly_canonical(path, failed);
    const auto apart =
        std::mismatch(real_folder.begin(), real_folder.end(), real_path.begin(), real_path.end());
    inside = !failed && apart.first == real_folder.end();
  }
  if (!inside)
    throw Error(ErrorCode::refused_input, file + ": found a reference to the file " + reference +
                                              ", expected one in the same folder or below");
  return path.string();
}

}  // namespace voyager
