#include "runtime/base/path_beside.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "runtime/base/error.h"

namespace voyager {
namespace {

using Path = std::filesystem::path;

}  // namespace

bool stays_in_folder(std::string_view path) {
  constexpr std::string_view kNever("\\\0", 2);
  if (path.empty() || path.find_first_of(kNever) != path.npos) return false;
  const Path parts(path);
  return parts.is_relative() &&
         std::none_of(parts.begin(), parts.end(), [](const Path& part) { return part == ".."; });
}

std::string path_beside(const std::string& file, const std::string& reference) {
  const Path folder = Path(file).parent_path();
  const Path path = (folder.empty() ? Path(".") : folder) / reference;
  bool inside = stays_in_folder(reference);
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
